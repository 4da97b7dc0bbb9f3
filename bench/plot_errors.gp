# Error against time, one line a p_l: left all pixels, right without the 0.1 % worst, for a
# few chains that stay long at a bright path, or a few such paths in the reference, rule the
# former. Wants: out (folder of auto.csv and p<value>.csv), manual ("p p p"), p_auto, scene.
set terminal svg size 1180,520 font 'DejaVu Sans,14' enhanced background rgb 'white'
set output out.'/errors.svg'
set datafile separator ','
set logscale xy
set format x '%g'
set format y '10^{%T}'
set xlabel 'CPU time, all threads [s]'
set ylabel 'error against a bdpt reference'
set grid xtics ytics mytics lt 1 lc rgb '#dddddd', lt 1 lc rgb '#f2f2f2'
set border 3 lc rgb '#444444'
set tics nomirror

# Told apart without colour too: by marks and dashes.
array colours[6] = ['#0072b2', '#009e73', '#cc79a7', '#56b4e9', '#e69f00', '#999999']
columns = 'relmse relmse_trimmed'
titles = "'relMSE, all pixels' 'relMSE without the 0.1 % worst pixels'"
file(p) = out.'/p'.p.'.csv'

set multiplot layout 1,2 title scene.': automatic and manual large-step probability'
do for [panel = 1:2] {
    set title word(titles, panel)
    if (panel == 1) { unset key } else { set key bottom left spacing 1.2 opaque; unset ylabel }
    plot out.'/auto.csv' using (column('cpu_s')):(column(word(columns, panel))) \
            with linespoints lw 3.5 dt 1 pt 7 ps 0.8 lc rgb '#d55e00' \
            title 'automatic, p_l  = '.p_auto, \
        for [i = 1:words(manual)] file(word(manual, i)) \
            using (column('cpu_s')):(column(word(columns, panel))) with linespoints \
            lw 1.5 dt i+1 pt 2*i+2 ps 0.6 lc rgb colours[i] \
            title 'p_l  = '.word(manual, i)
}
unset multiplot

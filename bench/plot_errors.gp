# Error against time, one line a p_l: left all pixels, right without the 1 % worst, for a
# few chains that stay long at a bright path, or a few such paths in the reference, rule the
# former. Wants: out (folder of auto.csv and p<value>.csv), manual ("p p p"), p_auto, scene,
# noise ("relmse trimmed" of the reference itself); reference (whose) and
# keyplace may be given.
set terminal svg size 1180,560 font 'DejaVu Sans,15' enhanced background rgb 'white'
set output out.'/errors.svg'
set datafile separator ','
set logscale xy
set format x '%g'
set format y '%g'
set xlabel 'CPU time, all threads [s]'
set ylabel 'error against '.(exists('reference') ? reference : 'the bdpt reference')
set xrange [*:*] noextend
set xtics (.01, .02, .05, .1, .2, .5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000)
set grid xtics ytics mytics lt 1 lc rgb '#d8d8d8', lt 1 lc rgb '#efefef'
set border 3 lc rgb '#444444'
set tics nomirror

# Told apart without colour too: by marks and dashes.
array colours[6] = ['#0072b2', '#009e73', '#cc79a7', '#56b4e9', '#e69f00', '#999999']
columns = 'relmse relmse_trimmed'
titles = "'relMSE, all pixels' 'relMSE without the 1 % worst pixels'"
if (!exists('keyplace')) keyplace = 'top right'
file(p) = out.'/p'.p.'.csv'

# The slope of independent samples, through the middle of the automatic run's points.
stats out.'/auto.csv' using 2 every ::1 nooutput
row = int(STATS_records / 2)
middle_t = real(system("awk -F, 'NR == ".(row + 1)." { print $2 }' ".out.'/auto.csv'))
middle(c) = real(system("awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == \"".c.\
    "\") at = i } NR == ".(row + 1)." { print $at }' ".out.'/auto.csv'))

set multiplot layout 1,2 title scene.': automatic and manual large-step probability p_l' \
    noenhanced
do for [panel = 1:2] {
    c = word(columns, panel)
    level = real(word(noise, panel))
    anchor = 0.6 * middle(c) * middle_t
    set title word(titles, panel)
    if (panel == 1) { unset key } else { set key @keyplace spacing 1.15 samplen 3; unset ylabel }
    plot out.'/auto.csv' using (column('cpu_s')):(column(c)) \
            with linespoints lw 3.5 dt 1 pt 7 ps 0.7 lc rgb '#d55e00' \
            title 'automatic, p_l = '.p_auto noenhanced, \
        for [i = 1:words(manual)] file(word(manual, i)) \
            using (column('cpu_s')):(column(c)) with linespoints \
            lw 1.5 dt i+1 pt 2*i+2 ps 0.6 lc rgb colours[i] \
            title 'p_l = '.word(manual, i) noenhanced, \
        anchor / x with lines lw 1.5 dt 3 lc rgb '#888888' title 'slope of 1/N', \
        level with lines lw 2 dt 1 lc rgb '#222222' title "the reference's own noise"
}
unset multiplot

# Error against time, one line a p_l. Wants: out (folder of auto.csv and p<value>.csv),
# manual ("p p p"), p_auto (what the automatic choice was), scene.
set terminal svg size 800,540 font 'DejaVu Sans,14' enhanced background rgb 'white'
set output out.'/errors.svg'
set datafile separator ','
set logscale xy
set format x '%g'
set format y '10^{%T}'
set xlabel 'CPU time, all threads [s]'
set ylabel 'relMSE against a bdpt reference'
set title scene.': automatic and manual large-step probability'
set key top right spacing 1.3
set grid xtics ytics mytics lt 1 lc rgb '#dddddd', lt 1 lc rgb '#f2f2f2'
set border 3 lc rgb '#444444'
set tics nomirror

# Told apart without colour too: by marks and dashes.
array colours[6] = ['#0072b2', '#009e73', '#cc79a7', '#56b4e9', '#e69f00', '#999999']
file(p) = out.'/p'.p.'.csv'

plot out.'/auto.csv' using (column('cpu_s')):(column('relmse')) with linespoints \
        lw 3.5 dt 1 pt 7 ps 0.8 lc rgb '#d55e00' title 'automatic, p_l  = '.p_auto, \
    for [i = 1:words(manual)] file(word(manual, i)) \
        using (column('cpu_s')):(column('relmse')) with linespoints \
        lw 1.5 dt i+1 pt 2*i+2 ps 0.6 lc rgb colours[i] \
        title 'p_l  = '.word(manual, i)

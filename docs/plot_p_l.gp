# docs/p_l.svg. Wants: tmp (folder of small.dat and large.dat), values (values.dat of the
# demo), out.
set terminal svg size 1080,370 font 'DejaVu Sans,13' enhanced background rgb 'white'
set output out
set border 15 lc rgb '#444444'
set multiplot

# --- sketch: the unit square with three bright spots -----------------------------------
set style fill solid noborder
spots = '.28 .32 .09 .72 .70 .08 .20 .80 .05'
do for [i = 0:2] {
    do for [k = 1:2] {
        set object 2*i+k circle at real(word(spots, 3*i+1)), real(word(spots, 3*i+2)) \
            size real(word(spots, 3*i+3))*(3-k)*1.1 behind \
            fc rgb (k == 1 ? '#fff0c2' : '#ffd966')
    }
}
set xrange [0:1]; set yrange [0:1]
unset xtics; unset ytics
set size square 0.3,0.86
set key below Left reverse samplen 1 spacing 1.2
set origin 0.01,0.1
set title "small steps (sketch):\nthe chain explores one bright spot"
plot tmp.'/small.dat' using 1:($3==0?$2:NaN) with points pt 6 ps 0.45 lc rgb '#888888' title 'rejected', \
    '' using 1:($3==1?$2:NaN) with points pt 7 ps 0.4 lc rgb '#0072b2' title 'accepted'
set origin 0.31,0.1
set title "large steps (sketch): independent samples,\nwhich find all spots and are mostly rejected"
plot tmp.'/large.dat' using 1:($3==0?$2:NaN) with points pt 6 ps 0.45 lc rgb '#888888' title 'rejected', \
    '' using 1:($3==1?$2:NaN) with points pt 7 ps 0.4 lc rgb '#0072b2' title 'accepted'

# --- measured --------------------------------------------------------------------------
unset object
set datafile separator "\t"
set size nosquare
set size 0.39,0.97
set origin 0.61,0
set border 3
set tics nomirror
set grid lt 1 lc rgb '#e0e0e0'
set yrange [0:*]
set xtics 0,.2,1
set ytics autofreq format '%g'
set xlabel 'large-step probability p_l' noenhanced
set ylabel 'error (trimmed relMSE)'
set key below Left reverse noenhanced
stats values using 2 every ::0::0 nooutput
automatic = sprintf('automatic: %.2f', STATS_mean)
stats values using 10 nooutput
set title sprintf("measured on glass-caustic:\nerror after %.2g CPU seconds", STATS_min)
plot values using 2:3:4:5 every ::1 with yerrorbars lw 1.6 pt 7 ps 0.5 lc rgb '#0072b2' \
        title 'manual', \
    values using 2:3 every ::1 with lines lw 1.6 lc rgb '#0072b2' notitle, \
    values using 2:3:4:5 every ::0::0 with yerrorbars lw 2.5 pt 13 ps 0.8 lc rgb '#d55e00' \
        title automatic
unset multiplot

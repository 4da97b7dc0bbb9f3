# The two plots of `make demo`. Wants: out (the folder with curves.dat and values.dat, as
# bench/demo.awk writes them, and predicted.dat of bench/demo_predicted.awk), noise (of the
# reference, in the same error).
set datafile separator "\t"
set border 3 lc rgb '#444444'
set tics nomirror
set grid xtics ytics mytics lt 1 lc rgb '#d8d8d8', lt 1 lc rgb '#efefef'
set format y '%g'
error_name = 'relMSE without the 1 % worst pixels'
values = out.'/values.dat'
curves = out.'/curves.dat'
manual = int(system("grep -vcE '^(auto|published)' ".values))
name(i) = system(sprintf("sed -n '%dp' %s | cut -f 1", i + 2, values))
stats values using 2 every ::0::0 nooutput
automatic = sprintf('automatic, p_l = %.2f', STATS_mean)
stats values using 2 every ::1::1 nooutput
published = sprintf('published rule, p_l = %.2f', STATS_mean)
stats values using 10 nooutput
compared_at = STATS_min
# Marks and dashes tell the lines apart without colour too.
array colours[6] = ['#0072b2', '#56b4e9', '#009e73', '#e69f00', '#cc79a7', '#777777']

# --- error against time; the legend stands beside the plot ----------------------------
set terminal svg size 960,480 font 'DejaVu Sans,15' enhanced background rgb 'white'
set output out.'/errors.svg'
set title sprintf("glass-caustic: error against time\n(noise of the reference: %.2g)", noise)
set logscale xy
set xlabel 'CPU time [s]'
set ylabel error_name
set xrange [*:*] noextend
set format x '%g'
set xtics (.1, .2, .3, .5, 1, 2, 3, 5, 10, 20)
set ytics (.002, .005, .01, .02, .05, .1, .2, .5)
stats curves using 4:5 nooutput
set yrange [0.9*STATS_min_x:1.1*STATS_max_y]
set key outside right top Left reverse spacing 1.3 samplen 3 noenhanced
plot curves index 0 using 2:3 with linespoints lw 3.5 pt 7 ps 0.7 lc rgb '#d55e00' title automatic, \
    curves index 0 using 2:4:5 with filledcurves lc rgb '#d55e00' fs transparent solid 0.2 noborder \
        title 'its 95 % interval', \
    curves index 1 using 2:3 with linespoints lw 2.4 pt 5 ps 0.6 lc rgb '#222222' title published, \
    for [i = 1:manual] curves index i+1 using 2:3 with linespoints lw 1.8 dt i+1 pt 2*i+2 ps 0.6 \
        lc rgb colours[(i-1)%6+1] title 'manual, p_l = '.name(i)

# --- error against p_l --------------------------------------------------------------------
set terminal svg size 800,560 font 'DejaVu Sans,15' enhanced background rgb 'white'
set output out.'/p_l.svg'
set title sprintf('glass-caustic: error after %.2g CPU seconds', compared_at)
unset logscale
set xlabel 'large-step probability p_l' noenhanced
set xrange [0:1]
set xtics autofreq
set ytics autofreq
set key outside below noenhanced
# The prediction near p_l = 0 and 1 may lie far above all that was measured.
stats values using 5 nooutput
set yrange [0:1.3*STATS_max]
plot out.'/predicted.dat' using 1:2 with lines lw 1.8 dt 2 lc rgb '#222222' \
        title 'predicted by the starts of the automatic runs (relMSE)', \
    values using 2:3:4:5 every ::2 with yerrorbars lw 1.8 pt 7 ps 0.6 lc rgb '#0072b2' \
        title 'measured: manual values, 95 % intervals', \
    values using 2:3 every ::2 with lines lw 1.8 lc rgb '#0072b2' notitle, \
    values using 2:3:4:5 every ::1::1 with yerrorbars lw 2.4 pt 5 ps 0.8 lc rgb '#222222' \
        title 'measured: '.published, \
    values using 2:3:4:5 every ::0::0 with yerrorbars lw 3 pt 13 ps 0.9 lc rgb '#d55e00' \
        title 'measured: '.automatic

# Memory and statistics of a long run. Wants: out (path of NAME-samples.csv and
# NAME-blocks.csv without their endings), name.
set terminal svg size 1180,820 font 'DejaVu Sans,14' enhanced background rgb 'white'
set output out.'.svg'
set datafile separator ','
set border 3 lc rgb '#444444'
set tics nomirror
set grid xtics ytics lt 1 lc rgb '#e4e4e4'
samples = out.'-samples.csv'
blocks = out.'-blocks.csv'
stats samples using (column('wall_s')) every ::1 nooutput
minutes = STATS_max / 60
set xrange [0:minutes]
set multiplot layout 2,2 title name.': a long run of mmlt' noenhanced

set xlabel 'minutes'
set ylabel 'MB'
set yrange [0:*]
set key bottom right
set title 'memory'
plot samples using (column('wall_s')/60):(column('data')/1e6) with lines lw 2 lc rgb '#999999' \
        title 'mapped', \
    '' using (column('wall_s')/60):(column('live_bytes')/1e6) with lines lw 2.5 lc rgb '#d55e00' \
        title 'live on the heap', \
    '' using (column('wall_s')/60):(column('resident')/1e6) with lines lw 2 lc rgb '#0072b2' \
        title 'resident'

set title 'allocations and page faults between two samples'
set ylabel 'count'
set yrange [0.5:*]
set logscale y
set key top right
plot samples using (column('wall_s')/60):(column('minor_faults')) with points pt 6 ps 0.4 \
        lc rgb '#0072b2' title 'minor page faults', \
    '' using (column('wall_s')/60):(column('calls')) with points pt 7 ps 0.4 \
        lc rgb '#d55e00' title 'calls of malloc and its kin (none: not shown)'
unset logscale y

# Each series about its own mean, in its own standard deviations, one above the other.
set title 'statistics by block of time, in standard deviations'
set ylabel ''
set yrange [-4:6*7-2]
set ytics ('b' 0, 'mean ratio' 6, 'eta_s' 12, 'eta_l' 18, 'eta_0' 24, 'acceptance' 30, \
    'failure rate' 36) noenhanced
unset key
array mean[7]
array sd[7]
do for [i = 1:7] {
    set xrange [*:*]
    stats blocks using (column(i + 1)) every ::1 nooutput
    mean[i] = STATS_mean
    sd[i] = STATS_stddev > 0 ? STATS_stddev : 1
}
set xrange [0:minutes]
plot for [i = 1:7] blocks using (60*column(1)):((column(i + 1)-mean[i])/sd[i]+6*(i-1)) \
        with linespoints pt 7 ps 0.5 lw 1.5 lc rgb '#009e73', \
    for [i = 1:7] 6*(i-1) with lines lw 1 dt 2 lc rgb '#999999'

set title 'speed by block of time'
set ylabel '% of its mean'
set format y '%g'
unset ytics
set ytics auto nomirror
set yrange [*:*]
set key bottom right
set xrange [*:*]
stats blocks using (column(9)) every ::1 nooutput
speed = STATS_mean
set xrange [0:minutes]
plot blocks using (60*column(1)):(100*column(9)/speed) with linespoints pt 7 ps 0.5 lw 2 \
        lc rgb '#0072b2' title 'mutations per CPU second'
unset multiplot

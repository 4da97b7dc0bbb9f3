# Figures 2 and 3 of [Zeng19] again, and the bias that they do not show. Wants: out, the
# folder with the data of bench/pfmcmc and bench/pfbias.
set datafile separator ','
set encoding utf8
set border 3 lc rgb '#444444'
set tics nomirror
blue = '#0072b2'; orange = '#d55e00'; green = '#009e73'; grey = '#888888'

# --- figure 2: target and samples ---------------------------------------------------------
set terminal svg size 1180,760 font 'DejaVu Sans,15' enhanced background rgb 'white'
set output out.'/figure2.svg'
target(x) = exp(-0.5 * ((x - 3) / 2) ** 2) / (2 * sqrt(2 * pi))
set samples 400
set xrange [-5:11]
set yrange [0:0.4]
set grid xtics ytics lt 1 lc rgb '#e4e4e4'
set xlabel 'x'
set ylabel 'density'
set key top right samplen 2
set multiplot layout 2,2 title "Samples of a normal target whose proposals fail with \
probability p_{f}, at equal work: about 1600 proposals" margins 0.08,0.98,0.09,0.87 spacing 0.1,0.17
do for [p = 0:1] {
    do for [m = 0:1] {
        pf = word('0.4 0.6', p + 1)
        stats out.'/figure2.csv' using (column('redraw') == m && \
            abs(column('p_f') - real(pf)) < 1e-6 ? column('mean_rmse') : NaN) nooutput
        set title sprintf("%s, p_{f} = %s, mean RMSE %.6f", \
            m ? 'failures redrawn (PFMCMC)' : 'failures counted (MCMC)', pf, STATS_mean)
        plot out.'/figure2.csv' using 'x':(column('redraw') == m && \
                abs(column('p_f') - real(pf)) < 1e-6 ? column('density') : NaN) \
                with histeps lw 2 lc rgb orange title 'samples of one run', \
            target(x) with lines lw 2.5 lc rgb blue title 'target'
        unset key
    }
}
unset multiplot

# --- figure 3: error over work --------------------------------------------------------------
reset
set datafile separator ','
set border 3 lc rgb '#444444'
set tics nomirror
set terminal svg size 900,640 font 'DejaVu Sans,15' enhanced background rgb 'white'
set output out.'/figure3.svg'
set title 'The 1D model: RMSE of the histogram over proposals, mean of 200 runs'
set logscale xy
set xrange [80:130000]
set format x '%.0f'
set format y '%g'
set xtics (100, 400, 1600, 6400, 25600, 102400)
set ytics (0.001, 0.002, 0.005, 0.01, 0.02, 0.05)
set yrange [0.0007:0.05]
set grid xtics ytics lt 1 lc rgb '#e4e4e4'
set xlabel 'proposals, failures included'
set ylabel 'RMSE'
set key bottom left spacing 1.2 samplen 4
pick(m, p) = sprintf("< awk -F, 'NR == 1 || ($1 == %d && $2 == %s)' %s/figure3.csv", m, p, out)
plot pick(0, '0.6') using 'proposals':'rmse' with linespoints lw 2 dt 2 pt 6 ps 0.7 \
        lc rgb orange title 'p_{f} = 0.6, failures counted (MCMC)', \
    pick(1, '0.6') using 'proposals':'rmse' with linespoints lw 2 dt 1 pt 7 ps 0.6 \
        lc rgb orange title 'p_{f} = 0.6, failures redrawn (PFMCMC)', \
    pick(0, '0.4') using 'proposals':'rmse' with linespoints lw 2 dt 2 pt 4 ps 0.7 \
        lc rgb blue title 'p_{f} = 0.4, failures counted (MCMC)', \
    pick(1, '0.4') using 'proposals':'rmse' with linespoints lw 2 dt 1 pt 5 ps 0.6 \
        lc rgb blue title 'p_{f} = 0.4, failures redrawn (PFMCMC)'

# --- what a constant p_f hides --------------------------------------------------------------
reset
set datafile separator ','
set border 3 lc rgb '#444444'
set tics nomirror
set terminal svg size 1180,560 font 'DejaVu Sans,15' enhanced background rgb 'white'
set output out.'/bias.svg'
set grid xtics ytics lt 1 lc rgb '#e4e4e4'
set multiplot layout 1,2 title 'Failures whose probability varies: pixel × light with \
a penumbra, σ = 0.01, p_{l} = 0.3' margins 0.08,0.98,0.13,0.83 spacing 0.1,0
set title 'error over work (paths traced, failures included)'
set logscale xy
set xrange [14:10000]
set xtics (16, 64, 256, 1024, 4096)
set format y '%g'
set yrange [0.02:0.7]
set ytics (0.02, 0.05, 0.1, 0.2, 0.5)
set xlabel 'mutations per pixel'
set ylabel 'RMSE over the mean pixel'
set key top right spacing 1.2 samplen 3
at = real(system("awk -F, '$1 == \"counted\" { print $2 }' ".out."/crossing.csv"))
set arrow 1 from at, graph 0 to at, graph 1 nohead dt 3 lw 1.5 lc rgb grey
set label 1 sprintf("from %.0f on\ncounted is better", at) at at / 1.1, graph 0.11 right \
    textcolor rgb '#444444'
plot out.'/errors.csv' using 1:'counted' with linespoints lw 2 dt 2 pt 6 ps 0.7 \
        lc rgb blue title 'counted (plain)', \
    '' using 1:'exact' with linespoints lw 2 pt 4 ps 0.7 lc rgb green \
        title 'exact (timid second proposal)', \
    '' using 1:'paper' with linespoints lw 2.5 pt 7 ps 0.6 lc rgb orange \
        title 'paper (biased)', \
    '' using 1:'paper_bias' with lines lw 1.5 dt 3 lc rgb orange title "paper's bias alone"
unset arrow 1
unset label 1
unset logscale
set title 'each pixel over the truth: all runs, 8192 mutations per pixel'
set xrange [-1:64]
set xtics 0, 16, 64
set yrange [0.75:1.05]
set ytics 0.75, 0.05, 1.05
set key bottom left Left reverse samplen 2
set format y '%.2f'
set xlabel 'pixel (lit; penumbra 13 to 38; sliver of the light; lit from 51)'
set ylabel 'pixel / truth'
plot out.'/bias.csv' using 1:'paper_exact' with lines lw 2 lc rgb '#222222' \
        title 'f Z / f by quadrature', \
    '' using 1:'counted' with points pt 6 ps 0.6 lc rgb blue title 'counted (plain)', \
    '' using 1:'exact' with points pt 4 ps 0.6 lc rgb green title 'exact', \
    '' using 1:'paper' with points pt 7 ps 0.6 lc rgb orange title 'paper (biased)'
unset multiplot

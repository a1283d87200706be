# Draws simulation.csv: rayengine bench --simulate --csv simulation.csv && gnuplot simulation.gp
set datafile separator ","
set terminal svg size 900,640 font "sans,13" background "white"
set output "simulation.svg"
set multiplot layout 2,2
set logscale x
set xrange [0.0007:1400]
set yrange [0:1.08]
set grid ytics lc rgb "#dddddd"
set format x "%g"
set ylabel "oracle's time / time"
set xlabel "GPU's rate / processor's"
do for [panel = 1:4] {
  rays = panel <= 2 ? 1000000 : 10000000
  latency = panel % 2 ? 0.0 : 0.01
  set title sprintf("%d million rays, latency %g ms", rays / 1000000, 1000 * latency)
  if (panel == 2) { set key at graph 0.38, graph 0.93 } else { unset key }
  plot for [i = 7:10] "simulation.csv" skip 1 \
    using ((strcol(1) eq "rates" && $5 == rays && abs($4 - latency) < 1e-9) ? $3 : NaN):(column(i)) \
    with linespoints lw (i == 7 ? 3 : 1.5) pt (i == 7 ? 7 : i - 6) ps 0.6 \
    title word("RayEngine even Cycles' LuxCore's", i - 6)
}
unset multiplot

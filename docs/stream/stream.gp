# Draws what stream_bench measured. For SCENE in bun_zipper.ply balls-s4.nff:
#   stream_bench passes SCENE > pass-NAME.csv; stream_bench loop SCENE > loop-NAME.csv
# then: gnuplot stream.gp
set datafile separator ","
set terminal svg size 900,380 font "sans,13" background "white" noenhanced
set grid lc rgb "#dddddd"

set output "pass.svg"
set multiplot layout 1,2
set xrange [0:1]
set yrange [0:1.25]
set xlabel "share of the rays that are left"
set ylabel "cost of a pass / cost of a full one"
set key bottom right
do for [name in "bun_zipper balls-s4"] {
  set title name eq "bun_zipper" ? "69,451 triangles" : "7,381 spheres and 2 triangles"
  plot x with lines dt 2 lc rgb "#888888" title "in proportion", \
    "pass-".name.".csv" skip 3 using 1:3 with linespoints lw 2 pt 7 ps 0.5 title "side by side, as sorted", \
    "" skip 3 using 1:5 with linespoints lw 2 pt 5 ps 0.5 title "scattered"
}
unset multiplot

set output "loop.svg"
set multiplot layout 1,2
set logscale x 2
set xrange [7:1200]
set xlabel "K, primitives a treelet holds at most"
set key top right
set ylabel "Mrays/s, by processor time of one core"
set yrange [0:5]
set title "rays"
rays(class, name) = "< grep ^" . class . " loop-" . name . ".csv"
plot for [name in "bun_zipper balls-s4"] rays("primary", name) using 2:3 with linespoints lw 2 pt 7 ps 0.5 title name." primary", \
  rays("random", "bun_zipper") using 2:3 with linespoints lw 2 pt 5 ps 0.5 title "bun_zipper random"
set ylabel "tests/s in the loop / of the kernel alone"
set yrange [0:1.35]
set key top left
set title "tests"
plot 0.6 with lines dt 2 lc rgb "#888888" title "goal", \
  for [name in "bun_zipper balls-s4"] rays("primary", name) using 2:6 with linespoints lw 2 pt 7 ps 0.5 title name." primary", \
  rays("random", "bun_zipper") using 2:6 with linespoints lw 2 pt 5 ps 0.5 title "bun_zipper random"
unset multiplot

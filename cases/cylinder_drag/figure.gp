# Stress on the cylinder beside the finite-element solution.
#   gnuplot -e "run='out/cylinder'" cases/cylinder_drag/figure.gp     (from the source folder)
if (!exists("run")) run = "out/cylinder_drag"
if (!exists("png")) png = run."/wall.png"
set terminal pngcairo size 900,380 font ",10"
set output png
set datafile separator ","
reference = "data/confined_cylinder/confined_cylinder_wall.csv"
stats run."/wall.csv" using (abs($1) < 4 ? $2 : NaN) nooutput
front = STATS_mean
set xlabel "angle from the front stagnation point [degrees]"
set xrange [0:180]; set xtics 45; set grid
set multiplot layout 1,2
set title "pressure, (p - p_{front})/({/Symbol r} U_b^2)"
plot reference using 1:2 with lines lw 2 lc "black" title "finite elements", \
     run."/wall.csv" every ::1 using ($1 >= -4 ? $1 : NaN):($2 - front) pt 7 ps 0.8 lc 7 title "normal probes, 15 cells"
set title "shear stress, {/Symbol t}/({/Symbol r} U_b^2)"
plot reference using 1:3 with lines lw 2 lc "black" title "finite elements", \
     run."/wall.csv" every ::1 using ($1 >= -4 ? $1 : NaN):3 pt 7 ps 0.8 lc 7 title "normal probes, 15 cells"
unset multiplot

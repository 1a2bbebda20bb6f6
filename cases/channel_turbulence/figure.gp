# FSI, figures 4(a) and 4(b): stresses and mean velocity, with spectral simulations; and the rms.
#   gnuplot -e "run='out/channel_turbulence'" cases/channel_turbulence/figure.gp   (source folder)
if (!exists("run")) run = "out/channel_turbulence"
if (!exists("png")) png = run."/channel.png"
set terminal pngcairo size 1300,430 font ",10"
set output png
set datafile separator ","
MKM = "data/channel/channel_MKM1999_retau180.csv"
LM = "data/channel/channel_LeeMoser2015_retau180_mean.csv"
AJ = "data/channel/channel_delAlamoJimenez_retau180.csv"
centres = run."/centres.csv"
faces = run."/faces.csv"
set grid
set multiplot layout 1,3
set title "stresses over {/Symbol t}_w  (FSI figure 4a)"
set xlabel "distance from the centre line, y_c/h"
set xrange [0:0.5]; set yrange [0:1.05]
set key top left
plot MKM using (0.5*(1-$1)):7 every ::1 with points pt 6 ps 0.7 lc "black" title "Moser et al. 1999", \
     MKM using (0.5*(1-$1)):($11/178.12) every ::1 with points pt 6 ps 0.7 lc "black" notitle, \
     faces using (0.5-$1):(-$7) every ::1 with lines lw 2 lc 7 title "Reynolds, -{/Symbol r}<u'v'>", \
     faces using (0.5-$1):11 every ::1 with lines lw 2 lc 6 title "viscous", \
     faces using (0.5-$1):13 every ::1 with lines lw 2 lc 2 title "total", \
     2*x with lines dt 2 lc "black" title "straight line"
set title "mean velocity  (FSI figure 4b)"
set xlabel "y^+"; set logscale x; set xrange [0.8:200]; set yrange [0:20]
plot MKM using 2:3 every ::1 with points pt 6 ps 0.7 lc "black" title "Moser et al. 1999", \
     LM using 2:3 every 6::1 with points pt 2 ps 0.6 lc "grey40" title "Lee, Moser 2015", \
     centres using 2:3 every ::1 with lines lw 2 lc 7 title "Breakwater", \
     x < 12 ? x : NaN with lines dt 2 lc "black" title "y^+", \
     x > 8 ? 2.5*log(x) + 5.5 : NaN with lines dt 3 lc "black" title "2.5 ln y^+ + 5.5"
set title "rms of fluctuations"
unset logscale x; set xrange [0:180]; set yrange [0:3]; set key top right
plot MKM using 2:4 every ::1 with points pt 6 ps 0.6 lc "black" title "Moser et al. 1999", \
     MKM using 2:5 every ::1 with points pt 6 ps 0.6 lc "black" notitle, \
     MKM using 2:6 every ::1 with points pt 6 ps 0.6 lc "black" notitle, \
     AJ using 2:11 every ::1 with points pt 2 ps 0.6 lc "grey40" title "p: del Alamo, Jimenez 2003", \
     centres using 2:5 every ::1 with lines lw 2 lc 7 title "u", \
     faces using 2:5 every ::1 with lines lw 2 lc 6 title "v", \
     centres using 2:7 every ::1 with lines lw 2 lc 2 title "w", \
     centres using 2:15 every ::1 with lines lw 2 lc 4 title "p"
unset multiplot

# The budget of k, two-point correlations and spectra (no reference at hand).
set output (exists("png2") ? png2 : run."/budget.png")
set multiplot layout 1,3
set title "budget of k over u_{/Symbol t}^4/{/Symbol n}"
set xlabel "y^+"; set xrange [0:60]; set yrange [-0.25:0.25]; set key top right
plot centres using 2:29 every ::1 with lines lw 2 lc 7 title "production", \
     centres using 2:31 every ::1 with lines lw 2 lc 6 title "dissipation", \
     centres using 2:33 every ::1 with lines lw 2 lc 2 title "turbulent transport", \
     centres using 2:35 every ::1 with lines lw 2 lc 4 title "pressure transport", \
     centres using 2:37 every ::1 with lines lw 2 lc 1 title "viscous diffusion", \
     centres using 2:($29+$31+$33+$35+$37) every ::1 with lines dt 2 lc "black" title "sum"
set title "R_{uu} at y^+ = 15"
set xlabel "r/h"; set xrange [0:*]; set yrange [-0.4:1]
plot run."/correlations_x.csv" using 1:5 every ::1 with lines lw 2 lc 7 title "along x", \
     run."/correlations_z.csv" using 1:5 every ::1 with lines lw 2 lc 6 title "along z"
set title "spectra over u_{/Symbol t}^2 h at y^+ = 15"
set xlabel "k h"; set logscale xy; set xrange [0.8:400]; set yrange [1e-9:10]; set format y "10^{%L}"
set key bottom left
plot run."/spectra_x.csv" using 1:5 every ::1 with lines lw 2 lc 7 title "u along x", \
     run."/spectra_x.csv" using 1:6 every ::1 with lines lw 2 lc 6 title "v along x", \
     run."/spectra_z.csv" using 1:5 every ::1 with lines lw 2 lc 2 title "u along z", \
     run."/spectra_z.csv" using 1:6 every ::1 with lines lw 2 lc 4 title "v along z"
unset multiplot

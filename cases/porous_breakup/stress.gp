# Densities of stress and strain before and after breaking (POROUS figures 6.9 and 6.10).
# usage: gnuplot -e "folder='out/porous'" cases/porous_breakup/stress.gp      writes FOLDER/stress.png
set terminal pngcairo size 1000,420 font 'sans,10'
set output folder.'/stress.png'
set datafile separator ','
set datafile commentschars '#'
set multiplot layout 1,2
set grid lc rgb '#dddddd'
set xrange [-0.5:2]
set logscale y
set yrange [0.01:*]
set ylabel 'probability density'
before = folder.'/stress-deformation.csv'
after = folder.'/stress-breakage.csv'
set xlabel 'largest principal stress over E s_0'
plot before using 1:2 every ::1 with lines lw 2 lc rgb 'black' title 'before breakage is enabled', \
     after using 1:2 every ::1 with lines lw 2 lc rgb '#c03020' title 'at the end'
set xlabel 'largest principal strain over s_0'
plot before using 1:4 every ::1 with lines lw 2 lc rgb 'black' notitle, \
     after using 1:4 every ::1 with lines lw 2 lc rgb '#c03020' notitle

solid s { for i in 0..1500 { c[i] = circle(center: (i * 0.01, sin(i * 3deg)), radius: 20) } }

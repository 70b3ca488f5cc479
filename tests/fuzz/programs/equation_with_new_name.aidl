assembly a { solid shell {} constrain { plus = cross_shape() } }

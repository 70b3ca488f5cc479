// Spellings that programs in other languages have for what is said elsewhere, and what they wrap it in.

// A vector by its coordinates is a point.
fn vector(x: length, y: length) = (x, y)
alias vec = vector
alias vec2 = vector
alias vec2d = vector
alias vector2 = vector
alias vector2d = vector
alias point2 = point
alias point2d = point
alias pt = point

// A constraint that is handed over is that constraint.
constraint add_constraint(condition: bool) { constrain condition }
constraint add_constraint(conditions: list) {
    for c in conditions { constrain c }
}
alias add_constraints = add_constraint
alias add_constr = add_constraint
alias add = add_constraint
alias constrain_to = add_constraint

alias centered_inside = centered_in
alias centred_inside = centered_in

alias fix = fixed
alias lock = fixed
alias ground = fixed
alias grounded = fixed
alias anchored = fixed

// An angle has its unit already.
fn degrees(angle: angle) = angle

// Geometry is made by its name alone.
alias make_point = point
alias make_line = line
alias make_arc = arc
alias make_circle = circle
alias make_ellipse = ellipse
alias make_bezier = bezier
alias make_rectangle = rectangle
alias make_square = square
alias make_triangle = triangle
alias make_polygon = polygon
alias make_polyline = polyline
alias make_path = path
alias make_text = text

alias arcsin = asin
alias arccos = acos
alias arctan = atan
alias arctan2 = atan2

// A path drawn with a pen of a width.
alias stroke = thick

// Offsets of common shapes: of the same kind and with the same names, so that they can be constrained. What
// stands in no formula here is worked out by exact geometry after solving, as is the drawing of these where
// their source has fillets.

fn offset(of: circle, distance: length) = circle(center: of.center, radius: of.radius + distance)
fn offset(of: ring, distance: length) = ring(
    center: of.center,
    outer_radius: of.outer.radius + distance,
    inner_radius: of.inner.radius - distance
)
fn offset(of: slot, distance: length) =
    slot(start: of.start, end: of.end, width: of.width + 2 * distance)

fn offset(of: rectangle, distance: length) = rectangle(
    center: of.center,
    width: of.width + 2 * distance,
    height: of.height + 2 * distance,
    angle: of.angle
)
fn offset(of: square, distance: length) =
    square(center: of.center, size: of.width + 2 * distance, angle: of.angle)
fn offset(of: rounded_rectangle, distance: length) = rounded_rectangle(
    center: (of.bottom_left + of.top_right) / 2,
    width: of.width + 2 * distance,
    height: of.height + 2 * distance,
    radii: [max(0, c.radius + distance) for c in [
        of.corner_bottom_left, of.corner_bottom_right, of.corner_top_right, of.corner_top_left
    ]],
    angle: of.angle
)
fn offset(of: regular_polygon, distance: length) = regular_polygon(
    center: of.center,
    radius: of.radius + distance / cos(180deg / of.sides),
    sides: of.sides,
    angle: of.angle
)

// Dimensions that a program asks for.

/// Draws a dimension: between two things, or of one that is round or a line. Nothing moves for it.
///
/// It takes the place of the one that would be drawn by itself. `offset` is how far its line stands from what it
/// measures, to the right or above, negative to the left or below. `tolerance` is written behind it as ±, `fit` with
/// its limits (ISO 286). Between `a.x` and `b.x` it is level.
///
/// ```aidl
/// solid plate {
///     body = rectangle(width: 80, height: 50)
///     hole eye { rim = circle(center: (-15, 5), diameter: 20) }
///     dimension(body.left, eye.rim.center, offset: 40, tolerance: 0.1)
///     dimension(eye.rim, fit: "H7")
/// }
/// ```
constraint dimension(a, b, offset: length = 0, tolerance: length = 0, fit: text = "") { }
constraint dimension(of, offset: length = 0, tolerance: length = 0, fit: text = "") { }

/// The colour between two: a share of the way from a to b, half of it unless said.
///
/// ```aidl
/// assembly beads {
///     for i in 0..4 {
///         @color(mix("gold", "teal", i / 4)) solid bead[i] { rim = circle(center: (20 * i, 0), radius: 10) }
///     }
/// }
/// ```
fn mix(a: text, b: text, share: number = 0.5) =
    if share < 0 or share > 1 then refuse("the share of the other colour is from 0 to 1") else between_colors(
        channels(a), channels(b), share
    )

// The same, of red, green and blue.
fn between_colors(a: list, b: list, share: number) = rgb(
    round(lerp(a[0], b[0], share)), round(lerp(a[1], b[1], share)), round(lerp(a[2], b[2], share))
)

/// A colour nearer to white by a share of the way, a quarter unless said.
///
/// ```aidl
/// param skin = "peru"
///
/// assembly mask {
///     @color(skin) solid face { rim = circle(center: (0, 0), radius: 30) }
///     @color(lighter(skin)) solid cheek { rim = circle(center: (12, -6), radius: 8) }
///     @color(lighter(skin, 0.6)) solid glint { rim = circle(center: (15, -3), radius: 2) }
/// }
/// ```
fn lighter(color: text, by: number = 0.25) = mix(color, "white", by)

/// A colour nearer to black by a share of the way, a quarter unless said.
///
/// ```aidl
/// solid lamp(tint: text = "seagreen") {
///     @color(tint) drawing shade { edge = trapezoid(center: (0, 20), bottom_width: 50, top_width: 24, height: 30) }
///     @color(darker(tint, 0.5)) drawing stand { post = line((0, 5), (0, -30)) }
/// }
///
/// assembly pair {
///     left = lamp()
///     right = lamp(tint: "chocolate") at (60, 0)
/// }
/// ```
fn darker(color: text, by: number = 0.25) = mix(color, "black", by)

/// A colour by its hue on the wheel (0deg red, 120deg green, 240deg blue), its saturation and its lightness, from 0 to 1.
/// Where one of them is larger, both are per cent.
///
/// ```aidl
/// assembly fan {
///     for i in 0..5 {
///         @color(hsl(60deg * i, 0.5, 0.6)) solid blade[i] {
///             edge = sector(center: origin, radius: 30, start_angle: 60deg * i, end_angle: 60deg * (i + 1))
///         }
///     }
/// }
/// ```
fn hsl(hue: angle, saturation: number, lightness: number) =
    if min(saturation, lightness) < 0 or max(saturation, lightness) > 100 then refuse(
        "saturation and lightness are from 0 to 1, or per cent"
    ) else if max(saturation, lightness) > 1 then of_shares(hue, saturation / 100, lightness / 100)
    else of_shares(hue, saturation, lightness)

fn of_shares(hue: angle, saturation: number, lightness: number) =
    of_hue(hue / 30deg, saturation * min(lightness, 1 - lightness), lightness)

// Red, green and blue of a hue, in twelfths of a turn (CSS Color Module Level 4, section 7.1).
fn of_hue(hue, strength, lightness) = rgb(
    of_turn(hue % 12, strength, lightness),
    of_turn((hue + 8) % 12, strength, lightness),
    of_turn((hue + 4) % 12, strength, lightness)
)
fn of_turn(twelfth, strength, lightness) =
    round(255 * (lightness - strength * max(-1, min(twelfth - 3, 9 - twelfth, 1))))

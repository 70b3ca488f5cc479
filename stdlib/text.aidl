// Lettering, for engraving and for cutting.

/// Lettering, to be engraved or cut; `height` is that of a capital letter, `center` the middle of the ink.
///
/// In a `drawing` it is engraved: filled in pictures, or with `outline: true` drawn as the outlines that cutters, DXF and
/// STEP get. In a `hole` it is cut out, in a `solid` it is material. Instead of its center `start` may be said: the point
/// of the baseline where the text begins (or as `align` says); instead of a height a `width`. `\n` begins a new line, and
/// `line_spacing` is between baselines, in heights. `glyph[i]` are the characters, spaces aside; `baseline` is the line
/// under the first line. The font is DejaVu Sans without kerning, a file found as an import is (`font: "My.ttf"`), or `"single line"`,
/// engraved in one pass. `stencil: true` (or a width, `2mm`) bridges letters that are cut; the box is that without.
///
/// `level` says what the `center` is the middle of, from below to above: the `ink`, unless said; the `line`, from the baseline of the
/// last line to the top of a capital in the first; or the `baseline` itself, of the first. By `line` a row of keys is level,
/// whatever hangs below or stands out of their letters. With `fit` instead of a size it is as large as fits into that box.
///
/// ```aidl
/// solid badge {
///     disc = circle(radius: 40)
///     drawing label {
///         construction way = circle(center: fixed((0, 0)), radius: 30)
///         name = text("HARBOUR BAKERY", along: way, height: 6, bold: true)
///         year = text("1931", center: fixed((0, -26)), height: 7, outline: true)
///     }
/// }
/// ```
shape text(
    text,
    center: point = (0, 0),
    height: length,
    angle: turn = 0deg,
    level: text = "ink",
    align: text = "center",
    line_spacing = 1.6,
    bold: bool = false,
    font: text = "DejaVu Sans",
    stencil = false,
    outline: bool = false,
    rotatable: bool = false
) {
    let side = choice(align, ["left", "center", "right"])
    let ink = ink(str(text), side, line_spacing, bold, font)
    let middle = level_of(ink, level, str(text), line_spacing, bold, font)
    let start = center - turned(middle_of(ink, height, middle), angle)
    letters = glyphs(
        str(text), start, height, angle, side, line_spacing, outline, bold, font, stencil
    )
    let glyph = letters.glyph
    let width = (ink.right - ink.left) * height
    let baseline = baseline_of(ink, start, height, angle)
}
/// From its `start`, which is on the baseline of its first line unless another `level` is said.
shape text(
    text,
    start: point,
    height: length,
    angle: turn = 0deg,
    level: text = "baseline",
    align: text = "left",
    line_spacing = 1.6,
    bold: bool = false,
    font: text = "DejaVu Sans",
    stencil = false,
    outline: bool = false,
    rotatable: bool = false
) {
    let side = choice(align, ["left", "center", "right"])
    let ink = ink(str(text), side, line_spacing, bold, font)
    let base = start - turned(
        (0, level_of(ink, level, str(text), line_spacing, bold, font) * height), angle
    )
    letters = glyphs(
        str(text), base, height, angle, side, line_spacing, outline, bold, font, stencil
    )
    let glyph = letters.glyph
    let center = base + turned(middle_of(ink, height, (ink.bottom + ink.top) / 2), angle)
    let width = (ink.right - ink.left) * height
    let baseline = baseline_of(ink, base, height, angle)
}
/// As wide as said.
shape text(
    text,
    center: point = (0, 0),
    width: length,
    angle: turn = 0deg,
    level: text = "ink",
    align: text = "center",
    line_spacing = 1.6,
    bold: bool = false,
    font: text = "DejaVu Sans",
    stencil = false,
    outline: bool = false,
    rotatable: bool = false
) {
    let side = choice(align, ["left", "center", "right"])
    let ink = ink(str(text), side, line_spacing, bold, font)
    let height = width / (ink.right - ink.left)
    let middle = level_of(ink, level, str(text), line_spacing, bold, font)
    let start = center - turned(middle_of(ink, height, middle), angle)
    letters = glyphs(
        str(text), start, height, angle, side, line_spacing, outline, bold, font, stencil
    )
    let glyph = letters.glyph
    let baseline = baseline_of(ink, start, height, angle)
}

/// Along a circle, an arc, a line or a path of these, of any structure above, and wherever it is solved to be.
///
/// It stands on the outside of a circle, centred at the top and reading clockwise; with `inside: true` on the inside, centred
/// at the bottom. On an arc, a line or a path it is centred in the middle, and there reads from left to right, upright; `inside` tells
/// the side of an arc all the same. `align` may be `left` or `right`, too. What is longer than its curve runs on beyond the ends.
shape text(
    text,
    along,
    height: length,
    inside = "upright",
    align: text = "center",
    line_spacing = 1.6,
    bold: bool = false,
    font: text = "DejaVu Sans",
    stencil = false,
    outline: bool = false
) {
    let side = choice(align, ["left", "center", "right"])
    glyph = lettered(
        str(text), along, height, side, line_spacing, inside, outline, bold, font, stencil
    )
}

/// As large as fits into a box, `margin` within it, that of an outline, of any structure above.
///
/// It stands in the middle of the box, by its `level`, and follows it. A tenth of the smaller side is left free unless said.
fn text(
    text,
    fit: box,
    margin: length = min(fit.width, fit.height) / 10,
    level: text = "ink",
    align: text = "center",
    line_spacing = 1.6,
    bold: bool = false,
    font: text = "DejaVu Sans",
    stencil = false,
    outline: bool = false
) = fitted_text(
    text,
    fit.center,
    fit.width - 2 * margin,
    fit.height - 2 * margin,
    align,
    line_spacing,
    bold,
    font,
    stencil,
    outline,
    level
)
shape fitted_text(
    text,
    center: point,
    room: length,
    tall: length,
    align: text,
    line_spacing,
    bold: bool,
    font: text,
    stencil,
    outline: bool,
    level: text
) {
    let side = choice(align, ["left", "center", "right"])
    let ink = ink(str(text), side, line_spacing, bold, font)
    let middle = level_of(ink, level, str(text), line_spacing, bold, font)
    let height = min(
        room / (ink.right - ink.left), tall / (2 * max(ink.top - middle, middle - ink.bottom))
    )
    let width = (ink.right - ink.left) * height
    let start = center - middle_of(ink, height, middle)
    letters = glyphs(
        str(text), start, height, 0deg, side, line_spacing, outline, bold, font, stencil
    )
    let glyph = letters.glyph
    let baseline = baseline_of(ink, start, height, 0deg)
}

// The middle of a text from its start, and the line under its first line.
fn middle_of(ink: record, height: length, middle: number) =
    ((ink.left + ink.right) / 2 * height, middle * height)
fn baseline_of(ink: record, start: point, height: length, angle: angle) = line(
    start + turned((ink.left * height, 0), angle), start + turned((ink.right * height, 0), angle)
)

// How far above the first baseline the middle is that a text is placed by, in heights.
fn level_of(ink: record, level: text, text: text, line_spacing: number, bold: bool, font: text) =
    middle_by(choice(level, ["ink", "line", "baseline"]), ink, text, line_spacing, bold, font)
fn middle_by(
    level: text, ink: record, text: text, line_spacing: number, bold: bool, font: text
) = if level == "ink" then (ink.bottom + ink.top) / 2 else if level == "baseline" then 0 else (1 - line_spacing * (lowest(
    text, 100, bold, font
) - lowest(text, 101, bold, font))) / 2
// The lowest ink at a spacing so wide that it is in the last line: it grows by the number of lines less one.
fn lowest(text: text, line_spacing: number, bold: bool, font: text) =
    ink(text, "left", line_spacing, bold, font).bottom

alias lettering = text

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
    let start = center - turned(middle_of(ink, height), angle)
    letters = glyphs(str(text), start, height, angle, side, line_spacing, outline, bold, font, stencil)
    let glyph = letters.glyph
    let width = (ink.right - ink.left) * height
    let baseline = baseline_of(ink, start, height, angle)
}
/// By the baseline of its first line.
shape text(
    text,
    start: point,
    height: length,
    angle: turn = 0deg,
    align: text = "left",
    line_spacing = 1.6,
    bold: bool = false,
    font: text = "DejaVu Sans",
    stencil = false,
    outline: bool = false,
    rotatable: bool = false
) {
    let side = choice(align, ["left", "center", "right"])
    letters = glyphs(str(text), start, height, angle, side, line_spacing, outline, bold, font, stencil)
    let glyph = letters.glyph
    let ink = ink(str(text), side, line_spacing, bold, font)
    let center = start + turned(middle_of(ink, height), angle)
    let width = (ink.right - ink.left) * height
    let baseline = baseline_of(ink, start, height, angle)
}
/// As wide as said.
shape text(
    text,
    center: point = (0, 0),
    width: length,
    angle: turn = 0deg,
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
    let start = center - turned(middle_of(ink, height), angle)
    letters = glyphs(str(text), start, height, angle, side, line_spacing, outline, bold, font, stencil)
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
    glyph = lettered(str(text), along, height, side, line_spacing, inside, outline, bold, font, stencil)
}

// The middle of the ink of a text from its start, and the line under its first line.
fn middle_of(ink: record, height: length) =
    ((ink.left + ink.right) / 2 * height, (ink.bottom + ink.top) / 2 * height)
fn baseline_of(ink: record, start: point, height: length, angle: angle) = line(
    start + turned((ink.left * height, 0), angle), start + turned((ink.right * height, 0), angle)
)

alias lettering = text

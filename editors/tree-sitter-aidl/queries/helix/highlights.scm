; Made by `make colours`; do not edit.

(line_comment) @comment.line

(doc_comment) @comment.line.documentation

(block_comment) @comment.block

(number) @constant.numeric

(unit) @type.builtin

[(unknown_unit) (ellipsis)] @error

(string) @string

(escape_sequence) @constant.character.escape

[(true) (false)] @constant.builtin.boolean

(todo_statement) @keyword

["param" "var" "let" "fn" "shape" "constraint" "alias"] @keyword.storage.type

["constrain" "prefer" "assert"] @keyword

["construction" "template"] @keyword.storage.modifier

["for"] @keyword.control.repeat

["if" "else" "then"] @keyword.control.conditional

["import" "from" "as"] @keyword.control.import

["at" "rotated" "in" "step" "weight"] @keyword

["and" "or" "not"] @keyword.operator

["==" "!=" "<=" ">=" "<" ">"] @operator

["+" "-" "*" "/" "%" "^" "**"] @operator

["!" "&&" "||"] @operator

[".." "..<"] @operator

["="] @operator

["(" ")" "[" "]" "{" "}"] @punctuation.bracket

["," ";" ":" "."] @punctuation.delimiter

["@"] @attribute

(identifier) @variable

((identifier) @variable.builtin
  (#any-of? @variable.builtin
    "self" "origin" "x_axis" "y_axis"))

((identifier) @constant.builtin
  (#any-of? @constant.builtin
    "pi"))

((member_expression object: (identifier) @namespace)
  (#any-of? @namespace
    "math" "np" "numpy"))

(member_expression property: (identifier) @variable.other.member)

(named_argument name: (identifier) @variable.parameter)

(call_expression function: (identifier) @function)

(call_expression function: (member_expression property: (identifier) @function.method))

((call_expression function: [(identifier) @constructor (member_expression property: (identifier) @constructor)])
  (#any-of? @constructor
    "point" "line" "arc" "circle" "bezier" "ellipse" "square" "rectangle" "frame" "rounded_rectangle"
    "chamfered_rectangle" "ring" "sector" "segment" "semicircle" "quarter_circle" "ring_sector" "slot"
    "arc_slot" "tapered_slot" "polygon" "polyline" "regular_polygon" "pentagon" "hexagon" "octagon"
    "star" "triangle" "right_triangle" "equilateral_triangle" "trapezoid" "right_trapezoid"
    "parallelogram" "rhombus" "kite" "strip" "path" "rectilinear_polygon" "text" "d_shape" "double_d"
    "keyhole" "lens" "crescent" "reuleaux" "arch" "pointed_arch" "ogive" "ogee_arch" "dome" "shield"
    "wheel" "rosette" "cog" "arrow" "double_arrow" "house" "drop" "heart" "egg" "squircle" "leaf" "cloud"
    "l_shape" "t_shape" "u_shape" "h_shape" "i_shape" "z_shape" "cross_shape" "chevron" "wave" "zigzag"
    "s_curve" "spiral" "cord" "coil" "spring" "chain" "ram" "link" "hinge" "bracket" "spline"
    "line_through" "finger_panel" "finger_edge" "finger_slots" "t_slot" "dogbone_rectangle"
    "corner_relief" "living_hinge" "clearance_hole" "tap_hole" "counterbore" "countersink" "hex_pocket"
    "bearing_seat" "gear" "internal_gear" "rack" "screw_hole" "bolt_circle" "hole_rectangle"
    "motor_mount" "vesa_mount" "raspberry_pi_mount" "bolt" "cap_screw" "machine_screw" "wood_screw" "nut"
    "washer" "angle_profile" "annular_sector" "annulus" "arched_door" "arched_window" "archway" "bar"
    "beveled_rectangle" "bolt_hole" "bolt_pattern" "bottle_cap" "box_panel" "bullet" "cable" "capsule"
    "captive_nut" "chamfered_rect" "channel_profile" "circular_sector" "circular_segment" "cogwheel"
    "coil_spring" "coiled_cord" "corner_holes" "crest" "curved_slot" "cyma" "d_hole" "d_shaft" "diamond"
    "disc" "disk" "donut" "double_d_shape" "doughnut" "escutcheon" "four_holes" "gothic" "gothic_arch"
    "gothic_window" "h_profile" "half_circle" "half_disc" "half_ellipse" "hanging_cord" "hex" "hex_bolt"
    "hex_nut" "i_beam" "i_profile" "isosceles_triangle" "kerf_bend" "l_profile" "lancet" "lattice_hinge"
    "lettering" "lune" "make_arc" "make_bezier" "make_circle" "make_ellipse" "make_line" "make_path"
    "make_point" "make_polygon" "make_polyline" "make_rectangle" "make_square" "make_text"
    "make_triangle" "moon" "nema_mount" "ngon" "nose_cone" "nut_pocket" "nut_trap" "oblong" "obround"
    "ogee" "oval" "pie" "pie_slice" "pill" "plain_washer" "plus" "plus_shape" "point2" "point2d" "pt"
    "quadrant" "rect" "reuleaux_triangle" "right_angled_triangle" "ring_gear" "rod" "round_arch"
    "round_rect" "round_rectangle" "rounded_rect" "s_bend" "sawtooth" "scalloped" "scalloped_circle"
    "scallops" "scroll" "semi_ellipse" "sine" "sine_wave" "spoked_wheel" "spur_gear" "squiggle" "stadium"
    "superellipse" "t_profile" "tapped_hole" "teardrop" "telephone_cord" "through_hole" "toothed_rim"
    "toothed_wheel" "trapezium" "two_headed_arrow" "u_profile" "vesica" "vesica_piscis" "volute"
    "wavy_line" "wedge" "wheel_with_spokes" "z_profile"))

((call_expression function: [(identifier) @function.builtin (member_expression property: (identifier) @function.builtin)])
  (#any-of? @function.builtin
    "mirror" "copy" "move" "rotate" "scale" "linear_array" "grid" "along" "polar_array" "fillet"
    "chamfer" "offset" "shell" "thick" "hull" "union" "intersect" "cut" "difference" "clip" "tiled"
    "fixed" "guess" "written" "nearest" "area" "perimeter" "centroid" "overlaps" "sin" "cos" "tan" "asin"
    "acos" "atan" "atan2" "sqrt" "abs" "hypot" "min" "max" "sum" "floor" "ceil" "round" "len" "range"
    "enumerate" "zip" "reversed" "str" "record" "choice" "rgb" "line_to" "line_by" "right" "left" "up"
    "down" "forward" "horizontal_to" "vertical_to" "polyline_to" "arc_to" "arc_by" "tangent_arc_to"
    "smooth_to" "wave_to" "zigzag_to" "scallops_to" "bezier_to" "quadratic_to" "close" "mirrored"
    "move_to" "hose" "wire" "strap_around" "rivets" "screws" "between" "anchor" "spot" "spots"
    "edge_point" "vertical_through" "horizontal_through" "distance" "horizontal_distance"
    "vertical_distance" "gap" "angle" "length" "radius" "diameter" "clearance" "hatching" "crosshatch"
    "mesh" "knurling" "threads" "ribs" "slats" "bricks" "tiles" "planks" "checkers" "dots" "honeycomb"
    "scales" "shingles" "wood_grain" "rays" "screw" "clearance_diameter" "nema" "bearing" "mesh_angle"
    "mix" "lighter" "darker" "hsl" "polar" "norm" "dot" "cross" "unit" "lerp" "turned" "vector"
    "direction" "radians" "circumcenter" "anchor_point" "anchored" "angle_between" "arccos" "arcsin"
    "arctan" "arctan2" "at_share" "close_mirrored" "dist" "distance_x" "distance_y" "fix" "ground"
    "grounded" "horizontal_axis" "lock" "orientation" "outline_distance" "place_in" "places_in"
    "point_between" "point_in" "rotation" "set_angle" "set_rotation" "stroke" "tilt" "tilted" "translate"
    "vec" "vec2" "vec2d" "vector2" "vector2d" "vertical_axis" "x_distance" "y_distance"))

((call_expression function: [(identifier) @function.builtin (member_expression property: (identifier) @function.builtin)])
  (#any-of? @function.builtin
    "same_width" "same_height" "same_size" "coincident" "on_segment" "concentric" "midpoint" "horizontal"
    "vertical" "parallel" "perpendicular" "collinear" "equal" "equal_length" "equal_radius" "tangent"
    "symmetric" "mirror_of" "meshes" "dimension" "above" "below" "left_of" "right_of" "beside"
    "on_top_of" "stacked_on" "inside" "contains" "centered_in" "centered_horizontally"
    "centered_vertically" "centered_between" "touching" "no_overlap" "overlapping" "on_circle"
    "at_corners" "spread" "align_left" "align_right" "align_top" "align_bottom" "align_center_x"
    "align_center_y" "flush" "row" "column" "evenly_spaced" "wider" "narrower" "taller" "shorter"
    "smaller" "larger" "above_of" "abuts" "adjacent" "adjacent_to" "align" "align_bottom_edges"
    "align_bottoms" "align_centers_x" "align_centers_y" "align_centre_x" "align_centre_y"
    "align_horizontal_centers" "align_left_edges" "align_left_sides" "align_lefts" "align_right_edges"
    "align_right_sides" "align_rights" "align_top_edges" "align_tops" "align_vertical_centers" "aligned"
    "aligned_bottom" "aligned_left" "aligned_right" "aligned_top" "alongside" "apart" "apart_from"
    "around_circle" "at_least" "at_midpoint" "at_most" "at_right_angle" "atop" "below_of" "beneath"
    "between_ends" "bigger" "bigger_than" "bolt_circle_of" "bottom_align" "bottom_aligned"
    "center_horizontally" "center_in" "center_inside" "center_on" "center_vertically" "centered"
    "centered_about" "centered_at" "centered_inside" "centered_on" "centered_with" "centered_x"
    "centered_y" "centre_horizontally" "centre_inside" "centre_vertically" "centred" "centred_between"
    "centred_horizontally" "centred_in" "centred_inside" "centred_vertically" "coaxial" "coaxial_with"
    "coincide" "coincident_with" "colinear" "collinear_with" "concentric_with" "congruent" "contained_by"
    "contained_in" "containing" "disjoint" "distribute" "distribute_evenly" "distribute_in"
    "does_not_overlap" "enclosed_by" "enclosed_in" "encloses" "equal_bottom" "equal_center_x"
    "equal_center_y" "equal_diameter" "equal_diameters" "equal_gaps" "equal_height" "equal_heights"
    "equal_left" "equal_lengths" "equal_radii" "equal_right" "equal_size" "equal_sizes" "equal_spacing"
    "equal_to" "equal_top" "equal_width" "equal_widths" "equally_spaced" "equals" "equidistant"
    "even_spacing" "evenly_distributed" "fits_in" "flush_bottom" "flush_left" "flush_right" "flush_top"
    "flush_with" "greater" "greater_than" "halfway_between" "higher_than" "horizontally_centered"
    "in_a_column" "in_a_row" "in_column" "in_corners" "in_row" "inside_of" "intersecting" "intersects"
    "larger_than" "left_align" "left_aligned" "left_from" "left_to_right" "less_than" "level" "lies_upon"
    "lower_than" "midpoint_of" "mirror_image" "mirror_image_of" "mirror_symmetric" "mirrored_from"
    "narrower_than" "next_to" "no_bigger_than" "no_intersection" "no_larger_than" "no_overlaps"
    "no_smaller_than" "non_overlapping" "normal" "normal_to" "not_overlapping" "on" "on_bolt_circle"
    "on_left_of" "on_right_of" "on_span" "on_the_left_of" "on_the_right_of" "on_top" "orthogonal"
    "orthogonal_to" "over" "overlap" "parallel_to" "parallel_with" "perpendicular_to" "point_on"
    "point_on_circle" "point_on_curve" "point_on_line" "rests_on" "right_align" "right_aligned"
    "right_angle" "right_from" "same" "same_bottom" "same_bottom_edge" "same_bottoms" "same_center"
    "same_center_as" "same_center_x" "same_center_y" "same_centers" "same_centre" "same_centre_x"
    "same_centre_y" "same_diameter" "same_diameters" "same_height_as" "same_heights" "same_left"
    "same_left_edge" "same_left_side" "same_lefts" "same_length" "same_lengths" "same_line" "same_point"
    "same_radii" "same_radius" "same_right" "same_right_edge" "same_right_side" "same_rights"
    "same_size_as" "same_sizes" "same_top" "same_top_edge" "same_tops" "same_width_as" "same_widths"
    "same_x" "same_y" "separate" "separate_from" "separated" "shorter_than" "side_by_side" "sits_on"
    "smaller_than" "smooth" "spread_inside" "spread_out" "square_to" "stack" "stack_on" "stacked"
    "stands_on" "surrounds" "symmetric_about" "symmetrical" "symmetry" "taller_than" "tangent_to"
    "tangent_with" "tangential" "to_corners" "to_left_of" "to_right_of" "to_the_left_of"
    "to_the_right_of" "top_align" "top_aligned" "top_to_bottom" "touch" "under" "underneath" "upright"
    "vertically_centered" "wider_than" "within" "within_ends"))

(structure kind: (identifier) @keyword.storage.type)

(structure name: (identifier) @type)

(structure name: (identifier) @type parameters: (parameters))

(attribute name: (identifier) @attribute)

(parameter name: (identifier) @variable.parameter)

(parameter type: (identifier) @type)

(function_definition name: (identifier) @function)

(shape_definition name: (identifier) @function)

(constraint_definition name: (identifier) @function)

(param_declaration name: (identifier) @variable)

(var_declaration name: (identifier) @variable)

(let_declaration name: (identifier) @variable)

(alias_declaration name: (identifier) @variable)

(import_statement name: (identifier) @variable)

(import_statement alias: (identifier) @variable)

(variables (identifier) @variable)

(assignment target: (identifier) @variable)

(assignment target: (index_expression object: (identifier) @variable))

(assignment target: (index_expression object: (index_expression object: (identifier) @variable)))

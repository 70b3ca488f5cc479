/**
 * @file The grammar of AIDL for editors. The language is defined by `grammar/aidl.lark`; this one takes the same
 * programs and refuses the same, as `tests/editors/test_tree_sitter.py` checks.
 * @license MIT
 */

/// <reference types="tree-sitter-cli/dsl" />
// @ts-check

// What Python's `\w` means, digits aside, and with them.
const LETTER = "\\p{L}\\p{Nl}\\p{No}_";
const WORD = LETTER + "\\p{Nd}";

const PRECEDENCE = {
  or: 1,
  and: 2,
  not: 3,
  add: 4,
  multiply: 5,
  sign: 6,
  power: 7,
};

/** @param {RuleOrLiteral} item */
const list = (item) => seq(item, repeat(seq(",", item)));

/** @param {RuleOrLiteral} item */
const trailing = (item) => seq(list(item), optional(","));

/**
 * Two operands and the sign or word between them; `left` and `right` are the levels they may come from.
 * @param {RuleOrLiteral} left
 * @param {RuleOrLiteral} operator
 * @param {RuleOrLiteral} right
 */
const operation = (left, operator, right) =>
  seq(field("left", left), field("operator", operator), field("right", right));

/**
 * @param {RuleOrLiteral} left
 * @param {RuleOrLiteral} right
 */
const arithmetic = (left, right) =>
  choice(
    prec.left(PRECEDENCE.add, operation(left, choice("+", "-"), right)),
    prec.left(PRECEDENCE.multiply, operation(left, choice("*", "/", "%"), right)),
    prec.right(PRECEDENCE.power, operation(left, choice("^", "**"), right)),
  );

/**
 * @param {RuleOrLiteral} left
 * @param {RuleOrLiteral} right
 */
const logic = (left, right) =>
  choice(
    prec.left(PRECEDENCE.or, operation(left, choice("or", "||"), right)),
    prec.left(PRECEDENCE.and, operation(left, choice("and", "&&"), right)),
  );

export default grammar({
  name: "aidl",

  // Newlines mean nothing: see the head of `grammar/aidl.lark` for what keeps statements apart.
  extras: ($) => [/[ \t\r\n\f\uFEFF]/, $.line_comment, $.doc_comment, $.block_comment],

  word: ($) => $.identifier,

  // Names nowhere. `then`, `as`, `from`, `True` and `False` are names wherever no keyword can stand.
  reserved: {
    global: (_) => [
      "alias", "and", "assert", "at", "constrain", "constraint", "construction", "else", "false", "fn", "for", "if",
      "import", "in", "let", "not", "or", "param", "prefer", "rotated", "shape", "step", "template", "todo", "true",
      "var", "weight",
    ],
  },

  supertypes: ($) => [$.statement, $.constraint_item, $.expression],

  conflicts: ($) => [
    // `let a = b if c` goes on with `else d`, or was complete before an `if` statement: `{ … }` tells.
    [$.expression, $.conditional_expression],
  ],

  rules: {
    source_file: ($) => repeat(choice($.statement, ";")),

    block: ($) => seq("{", repeat(choice($.statement, ";")), "}"),

    // What may stand inside `constrain { }`; commas may stand between, as well as nothing. Where nothing stands before
    // it that it would go on with, an item may begin with a sign.
    constraint_block: ($) => seq("{", repeat(choice($.constraint_item, $._signed_item, ";", ",")), "}"),
    _signed_item: ($) =>
      choice(
        alias($._signed_statement, $.expression_statement),
        alias($._signed_equation, $.equation),
      ),

    statement: ($) =>
      choice(
        $.structure,
        $.assignment,
        $.param_declaration,
        $.var_declaration,
        $.let_declaration,
        $.function_definition,
        $.shape_definition,
        $.constraint_definition,
        $.alias_declaration,
        $.import_statement,
        $.constrain_statement,
        $.prefer_statement,
        $.assert_statement,
        $.expression_statement,
        $.for_statement,
        $.if_statement,
        $.todo_statement,
      ),

    constraint_item: ($) =>
      choice(
        $.let_declaration,
        $.equation,
        $.prefer_statement,
        $.expression_statement,
        alias($._nested_constrain, $.constrain_statement),
        alias($._constraint_for, $.for_statement),
        alias($._constraint_if, $.if_statement),
      ),

    // --- Structures and geometry -------------------------------------------------------------------------------

    structure: ($) =>
      seq(
        repeat($.attribute),
        choice(
          seq(field("kind", $.identifier), field("name", $.identifier), repeat($.subscript)),
          seq(
            optional("template"),
            field("kind", $.identifier),
            field("name", $.identifier),
            field("parameters", $.parameters),
          ),
        ),
        optional(field("placement", $.placement)),
        field("body", $.block),
      ),

    // Before all other statements stands `@allow` alone; that is not said here.
    attribute: ($) =>
      seq(
        "@",
        field("name", $.identifier),
        optional(field("arguments", alias($._attribute_arguments, $.arguments))),
      ),
    _attribute_arguments: ($) => seq($._touching_parenthesis, optional(trailing($._argument)), ")"),

    placement: ($) =>
      choice(
        seq($._at, optional($._rotated)),
        seq($._rotated, optional($._at)),
      ),
    _at: ($) => seq("at", field("at", $._sum)),
    _rotated: ($) => seq("rotated", field("rotated", $._sum)),

    subscript: ($) => seq("[", list($.expression), "]"),

    parameters: ($) => seq($._touching_parenthesis, optional(trailing($.parameter)), ")"),
    parameter: ($) =>
      seq(
        field("name", $.identifier),
        optional(seq(":", field("type", $.identifier))),
        optional(seq("=", field("default", $.expression))),
      ),

    assignment: ($) =>
      seq(
        repeat($.attribute),
        optional("construction"),
        field("target", $._target),
        "=",
        choice(
          field("value", $.expression),
          seq(field("value", $._disjunction), field("placement", $.placement)),
        ),
      ),

    // --- Values ------------------------------------------------------------------------------------------------

    param_declaration: ($) =>
      seq(
        repeat($.attribute),
        "param",
        field("name", $.identifier),
        "=",
        field("value", choice($._sum, $.comparison_expression, alias($._param_conditional, $.conditional_expression))),
        optional(seq("in", field("domain", $._bounds))),
        optional(seq("step", field("step", $._sum))),
      ),
    // Its last operand is no comparison or range: `in` and `step` behind it belong to the param.
    _param_conditional: ($) =>
      seq(
        "if",
        field("condition", $._disjunction),
        "then",
        field("consequence", $.expression),
        "else",
        field("alternative", $._sum),
      ),

    var_declaration: ($) =>
      seq(repeat($.attribute), "var", field("name", $.identifier), "=", field("value", $.expression)),
    let_declaration: ($) =>
      seq(repeat($.attribute), "let", field("name", $.identifier), "=", field("value", $.expression)),

    function_definition: ($) =>
      seq(
        repeat($.attribute),
        "fn",
        field("name", $.identifier),
        field("parameters", $.parameters),
        "=",
        field("value", $.expression),
      ),

    shape_definition: ($) =>
      seq(
        repeat($.attribute),
        "shape",
        field("name", $.identifier),
        field("parameters", $.parameters),
        field("body", $.block),
      ),

    constraint_definition: ($) =>
      seq(
        repeat($.attribute),
        "constraint",
        field("name", $.identifier),
        field("parameters", $.parameters),
        field("body", $.constraint_block),
      ),

    alias_declaration: ($) =>
      seq(repeat($.attribute), "alias", field("name", $.identifier), "=", field("target", $.identifier)),

    import_statement: ($) =>
      seq(
        repeat($.attribute),
        "import",
        choice(
          field("path", $.string),
          seq(field("path", $.string), "as", field("alias", $.identifier)),
          seq(list(field("name", $.identifier)), "from", field("path", $.string)),
        ),
      ),

    todo_statement: ($) => seq(repeat($.attribute), "todo"),

    // --- Constraints -------------------------------------------------------------------------------------------

    constrain_statement: ($) =>
      seq(
        repeat($.attribute),
        "constrain",
        field(
          "body",
          choice(
            $.constraint_block,
            $.expression,
            alias($._bare_equation, $.equation),
            alias($._constraint_for, $.for_statement),
            alias($._constraint_if, $.if_statement),
          ),
        ),
      ),
    _nested_constrain: ($) =>
      choice(
        seq("constrain", field("body", $.constraint_block)),
        seq(
          repeat($.attribute),
          "constrain",
          field("body", choice($.expression, alias($._bare_equation, $.equation))),
        ),
      ),

    equation: ($) => seq(repeat($.attribute), field("left", $._first_sum), "=", field("right", $._disjunction)),
    _signed_equation: ($) => seq(field("left", $._signed_sum), "=", field("right", $._disjunction)),
    _bare_equation: ($) => seq(field("left", $._sum), "=", field("right", $._disjunction)),

    prefer_statement: ($) =>
      seq(repeat($.attribute), "prefer", field("value", $._disjunction), optional(seq("weight", field("weight", $._sum)))),

    assert_statement: ($) =>
      seq(repeat($.attribute), "assert", field("condition", $._disjunction), optional(seq(",", field("message", $._disjunction)))),

    // --- Control -----------------------------------------------------------------------------------------------

    for_statement: ($) => seq(repeat($.attribute), $._for_head, field("body", $.block)),
    _constraint_for: ($) => seq(repeat($.attribute), $._for_head, field("body", $.constraint_block)),
    _for_head: ($) => seq("for", list($.for_clause)),
    for_clause: ($) =>
      seq(field("variables", $.variables), "in", field("iterable", $._iterable)),
    variables: ($) => list($.identifier),

    if_statement: ($) => seq(repeat($.attribute), $._if),
    _if: ($) =>
      seq(
        "if",
        field("condition", $._disjunction),
        field("consequence", $.block),
        optional(field("alternative", $.else_clause)),
      ),
    else_clause: ($) => seq("else", choice($.block, alias($._if, $.if_statement))),

    _constraint_if: ($) => seq(repeat($.attribute), $._items_if),
    _items_if: ($) =>
      seq(
        "if",
        field("condition", $._disjunction),
        field("consequence", $.constraint_block),
        optional(field("alternative", alias($._constraint_else, $.else_clause))),
      ),
    _constraint_else: ($) => seq("else", choice($.constraint_block, alias($._items_if, $.if_statement))),

    // --- Expressions that begin a statement --------------------------------------------------------------------
    // No statement begins with `[`, `.`, an operator or a text, since such would go on with the one before it; and
    // what is no call, comparison or membership says nothing. These differ from the others in the first operand.

    expression_statement: ($) => seq(repeat($.attribute), $._first_disjunction),

    _first_disjunction: ($) => choice($._first_condition, alias($._first_logical, $.logical_expression)),
    _first_logical: ($) => logic(choice($._first_disjunction, $.parenthesized_expression), $._disjunction),

    _first_condition: ($) =>
      choice(
        alias($._first_call, $.call_expression),
        alias($._first_comparison, $.comparison_expression),
        alias($._first_membership, $.membership_expression),
      ),
    _first_comparison: ($) =>
      seq(
        field("operand", $._first_sum),
        repeat1(seq(field("operator", $._comparison_operator), field("operand", $._sum))),
      ),
    _first_membership: ($) =>
      seq(field("value", $._first_sum), $._membership_operator, field("container", $._bounds)),

    _first_sum: ($) => choice($._first_primary, alias($._first_binary, $.binary_expression)),
    _first_binary: ($) => arithmetic($._first_sum, $._sum),

    _first_primary: ($) => choice($._target, $._first_place),
    // What is no target of an assignment.
    _first_place: ($) =>
      choice(
        $.number,
        $.point,
        $.parenthesized_expression,
        // A sign behind it goes on with it.
        prec(1, alias($._first_call, $.call_expression)),
        alias($._first_member, $.member_expression),
        alias($._first_index, $.index_expression),
      ),
    _first_call: ($) =>
      seq(
        field("function", choice($.identifier, alias($._first_member, $.member_expression))),
        field("arguments", $.arguments),
      ),
    _first_member: ($) => seq(field("object", $._first_primary), ".", field("property", $.identifier)),
    _first_index: ($) => seq(field("object", $._first_place), field("index", $.subscript)),

    _target: ($) => choice($.identifier, alias($._indexed_target, $.index_expression)),
    _indexed_target: ($) => seq(field("object", $._target), field("index", $.subscript)),

    // The same with a sign before the first operand.
    _signed_statement: ($) => $._signed_disjunction,
    _signed_disjunction: ($) => choice($._signed_condition, alias($._signed_logical, $.logical_expression)),
    _signed_logical: ($) => logic($._signed_disjunction, $._disjunction),
    _signed_condition: ($) =>
      choice(
        alias($._signed_comparison, $.comparison_expression),
        alias($._signed_membership, $.membership_expression),
      ),
    _signed_comparison: ($) =>
      seq(
        field("operand", $._signed_sum),
        repeat1(seq(field("operator", $._comparison_operator), field("operand", $._sum))),
      ),
    _signed_membership: ($) =>
      seq(field("value", $._signed_sum), $._membership_operator, field("container", $._bounds)),
    _signed_sum: ($) => choice($.unary_expression, alias($._signed_binary, $.binary_expression)),
    _signed_binary: ($) => arithmetic($._signed_sum, $._sum),

    // --- Expressions -------------------------------------------------------------------------------------------

    expression: ($) => choice($._disjunction, $.conditional_expression),

    conditional_expression: ($) =>
      choice(
        seq(
          "if",
          field("condition", $._disjunction),
          "then",
          field("consequence", $.expression),
          "else",
          field("alternative", $.expression),
        ),
        seq(
          field("consequence", $._disjunction),
          "if",
          field("condition", $._disjunction),
          "else",
          field("alternative", $.expression),
        ),
      ),

    _disjunction: ($) => choice($._condition, $.logical_expression, $.not_expression),
    logical_expression: ($) => logic($._disjunction, $._disjunction),
    not_expression: ($) =>
      prec(PRECEDENCE.not, seq(field("operator", choice("not", "!")), field("operand", $._disjunction))),

    _condition: ($) => choice($._sum, $.range_expression, $.comparison_expression, $.membership_expression),
    comparison_expression: ($) =>
      seq(
        field("operand", $._sum),
        repeat1(seq(field("operator", $._comparison_operator), field("operand", $._sum))),
      ),
    _comparison_operator: (_) => choice("==", "!=", "<=", ">=", "<", ">"),
    membership_expression: ($) =>
      seq(field("value", $._sum), $._membership_operator, field("container", $._bounds)),
    _membership_operator: (_) => seq(optional("not"), "in"),

    range_expression: ($) => $._range,
    _stepped_range: ($) => seq($._range, "step", field("step", $._sum)),
    _range: ($) => seq(field("start", $._sum), field("operator", choice("..", "..<", $.ellipsis)), field("end", $._sum)),
    ellipsis: (_) => "...", // A slip, as other languages write `..`.
    _bounds: ($) => choice($._sum, $.range_expression),
    _iterable: ($) => choice($._bounds, alias($._stepped_range, $.range_expression)),

    _sum: ($) => choice($._primary, $.unary_expression, $.binary_expression),
    binary_expression: ($) => arithmetic($._sum, $._sum),
    unary_expression: ($) =>
      prec(PRECEDENCE.sign, seq(field("operator", choice("+", "-")), field("operand", $._sum))),

    _primary: ($) =>
      choice(
        $.identifier,
        $.number,
        $.string,
        $.true,
        $.false,
        $.parenthesized_expression,
        $.point,
        $.list,
        $.call_expression,
        $.member_expression,
        $.index_expression,
      ),

    call_expression: ($) =>
      seq(
        // `True` and `False` are names where a call's parenthesis touches them.
        field("function", choice($.identifier, alias(choice("True", "False"), $.identifier), $.member_expression)),
        field("arguments", $.arguments),
      ),
    member_expression: ($) => seq(field("object", $._primary), ".", field("property", $.identifier)),
    index_expression: ($) => seq(field("object", $._primary), field("index", $.subscript)),

    arguments: ($) =>
      seq($._touching_parenthesis, optional(choice($._arguments, $.comprehension)), ")"),
    // A comma stands behind each but the last; behind a block it may be left out.
    _arguments: ($) =>
      choice(
        seq(repeat($._separated_argument), $._argument),
        repeat1($._separated_argument),
      ),
    _separated_argument: ($) =>
      choice(seq($._argument, ","), seq(choice($.for_arguments, $.if_arguments), optional(","))),
    _argument: ($) => choice($.expression, $.named_argument),

    for_arguments: ($) => seq($._for_head, field("body", $.argument_block)),
    if_arguments: ($) =>
      seq(
        "if",
        field("condition", $._disjunction),
        field("consequence", $.argument_block),
        optional(field("alternative", alias($._else_arguments, $.else_clause))),
      ),
    _else_arguments: ($) => seq("else", choice($.argument_block, $.if_arguments)),
    // Where something stands before it that it would go on with, an argument begins as a statement does.
    argument_block: ($) =>
      seq(
        "{",
        repeat(seq(optional($._block_arguments), choice(",", ";", $.for_arguments, $.if_arguments))),
        optional($._block_arguments),
        "}",
      ),
    _block_arguments: ($) =>
      seq(choice($._argument_in_block, $.let_declaration), repeat(choice($._first_sum, $.let_declaration))),
    // `if` behind an argument begins a block: `a if c else b` stands in parentheses.
    _argument_in_block: ($) =>
      choice($._disjunction, alias($._conditional_in_block, $.conditional_expression)),
    _conditional_in_block: ($) =>
      seq(
        "if",
        field("condition", $._disjunction),
        "then",
        field("consequence", $.expression),
        "else",
        field("alternative", $._argument_in_block),
      ),
    named_argument: ($) => seq(field("name", $.identifier), choice(":", "="), field("value", $.expression)),

    parenthesized_expression: ($) => seq("(", $.expression, ")"),
    point: ($) => seq("(", field("x", $.expression), ",", field("y", $.expression), optional(","), ")"),
    list: ($) => seq("[", optional(choice(trailing($.expression), $.comprehension)), "]"),
    comprehension: ($) =>
      seq(
        field("element", $.expression),
        repeat1(seq($._for_head, optional(seq("if", field("condition", $._disjunction))))),
      ),

    // --- Tokens ------------------------------------------------------------------------------------------------

    identifier: (_) => new RegExp(`[${LETTER}][${WORD}]*`, "u"),

    // A parenthesis that touches the name before it begins a call; behind white space it begins a statement.
    _touching_parenthesis: (_) => alias(token.immediate("("), "("),

    number: ($) =>
      seq(/([0-9]+(\.[0-9]+)?|\.[0-9]+)([eE][+-]?[0-9]+)?/, optional(choice($.unit, $.unknown_unit))),
    // Before the keyword `in`.
    unit: (_) => token.immediate(prec(1, choice("mm", "cm", "m", "in", "ft", "deg", "rad", "turn", "°"))),
    // A slip: `5inch`, `1.2.3`. It has a node, so that what stands around it is read as ever.
    unknown_unit: (_) => 
      token.immediate(prec(1, new RegExp(`[${WORD}°]+|[${WORD}°]*\\.[0-9][${WORD}°]*`, "u"))),

    string: ($) =>
      choice(
        seq('"', repeat(choice(alias($._double_quoted, $.string_content), $.escape_sequence)), token.immediate('"')),
        seq("'", repeat(choice(alias($._single_quoted, $.string_content), $.escape_sequence)), token.immediate("'")),
      ),
    _double_quoted: (_) => token.immediate(prec(1, /[^"\\\n]+/)),
    _single_quoted: (_) => token.immediate(prec(1, /[^'\\\n]+/)),
    escape_sequence: (_) => token.immediate(/\\[^\n]/),

    true: (_) => choice("true", "True"),
    false: (_) => choice("false", "False"),

    doc_comment: (_) => token(/\/\/\/([^\/\n][^\n]*)?/),
    line_comment: (_) => token(choice(/\/\/[^\n]*/, /#[^\n]*/)),
    block_comment: (_) => token(/\/\*[^*]*\*+([^\/*][^*]*\*+)*\//),
  },
});

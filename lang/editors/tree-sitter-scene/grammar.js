/**
 * The scene language, edition 1, for editors.
 *
 * The grammar of record is `lang/src/scene.pest`; the tests compare the two on every scene of the
 * project. What only a look at the rest of the line can tell is read by `src/scanner.c`: a unit and
 * the kind of an object, which never stand on another line than what they belong to.
 */

/// <reference types="tree-sitter-cli/dsl" />
// @ts-check

/** How strongly operators bind, from the weakest. */
const BINARY = [
  "||",
  "&&",
  choice("==", "!=", "<=", ">=", "<", ">"),
  choice("..", "..="),
  choice("+", "-"),
  choice("*", "/", "%"),
];
const UNARY = BINARY.length + 1;
const POWER = UNARY + 1;
const POSTFIX = POWER + 1;

/** One or more, separated, perhaps with a separator at the end. */
const list = (rule, separator = ",") =>
  seq(rule, repeat(seq(separator, rule)), optional(separator));

module.exports = grammar({
  name: "scene",

  word: ($) => $.identifier,

  extras: ($) => [/[ \t\r\n\uFEFF]/, $.comment],

  // A word of the same line: see `src/scanner.c`.
  externals: ($) => [$.unit, $.kind],

  // No name, even where the word itself cannot stand: so a mistake ends at the next statement.
  reserved: {
    words: () => [
      "let", "param", "fn", "for", "if", "else", "include", "import", "use", "place", "set",
      "assert", "expect", "units", "with", "as", "in", "true", "false",
    ],
  },

  supertypes: ($) => [$._expression, $._statement_node],

  conflicts: ($) => [
    // `where` and `version` are names, too: what follows tells.
    [$.expect_statement],
    [$.use_statement],
  ],

  rules: {
    // A piece of a scene, as in a manual, has no header.
    source_file: ($) => seq(optional($.header), repeat($._statement), repeat($.doc)),

    header: ($) => seq("scene", field("version", alias($.number, $.version))),

    comment: () => token(choice(
      // `//!` and `////` are comments, `///` is not.
      /\/\/([^\/\n][^\n]*)?/,
      /\/\/\/\/[^\n]*/,
      /\/\*[^*]*\*+([^\/*][^*]*\*+)*\//,
    )),

    doc: () => /\/\/\/([^\/\n][^\n]*)?/,

    // ------------------------------------------------------------------ statements

    _statement: ($) => seq(
      repeat($.doc), repeat($.attribute), $._statement_node, optional(choice(",", ";"))),

    _statement_node: ($) => choice(
      $.let_statement, $.param_statement, $.fn_statement, $.for_statement, $.if_statement,
      $.include_statement, $.import_statement, $.use_statement, $.place_statement, $.set_statement,
      $.assert_statement, $.expect_statement, $.units_statement, $.field, $.object,
      $.call_statement,
    ),

    attribute: ($) => seq("@", token.immediate(/[A-Za-z_][A-Za-z0-9_]*/)),

    block: ($) => seq("{", repeat($._statement), repeat($.doc), "}"),

    let_statement: ($) => seq(
      "let", field("name", $._name), optional(seq(":", field("type", $.type))),
      "=", field("value", $._expression)),

    param_statement: ($) => seq(
      "param", field("name", $._name), ":", field("type", $.type), "=", field("value", $._expression),
      optional(seq("in", field("range", $._expression)))),

    fn_statement: ($) => seq(
      "fn", field("name", $._name), field("parameters", $.parameters),
      choice(seq("=", field("value", $._expression)), field("body", $.block))),

    parameters: ($) => seq("(", optional(list($.parameter)), ")"),

    parameter: ($) => seq(
      field("name", $._name), ":", field("type", $.type),
      optional(seq("=", field("default", $._expression)))),

    for_statement: ($) => seq("for", $._loop, field("body", $.block)),

    _loop: ($) => seq($._loop_names, "in", field("over", $._condition)),

    _loop_names: ($) => seq(
      field("name", $._name), optional(seq(",", field("name", $._name)))),

    if_statement: ($) => prec.right(seq(
      "if", field("condition", $._condition), field("consequence", $.block),
      repeat($.else_if), optional(seq("else", field("alternative", $.block))))),

    else_if: ($) => seq("else", "if", field("condition", $._condition), field("consequence", $.block)),

    include_statement: ($) => seq(
      "include", field("path", $.string), optional(seq("with", field("values", $.record)))),

    import_statement: ($) => seq("import", field("path", $.string), "as", field("name", $._name)),

    use_statement: ($) => seq(
      "use", "plugin", field("plugin", $.string),
      optional(seq("version", field("version", $.string)))),

    place_statement: ($) => seq(
      "place", field("what", $.path), optional(field("label", $.string)),
      optional(field("body", $.block))),

    set_statement: ($) => seq("set", field("path", $.path), "=", field("value", $._expression)),

    assert_statement: ($) => seq(
      "assert", field("condition", $._condition), ",", field("message", $.string)),

    expect_statement: ($) => seq(
      "expect", field("what", $.identifier),
      choice(
        field("path", $.string),
        seq(
          optional(field("at", $.arguments)), "=", field("value", $._operand),
          optional(seq(choice("±", "+-"), field("tolerance", $._operand)))),
      ),
      optional(seq("where", field("given", $.record)))),

    units_statement: ($) => seq("units", field("units", $.record)),

    field: ($) => seq(field("name", $._name), "=", field("value", $._expression)),

    object: ($) => seq(
      field("category", $.identifier), optional(field("kind", $.kind)),
      optional(field("label", $.string)), field("body", $.block)),

    call_statement: ($) => seq(field("function", $.path), field("arguments", $.arguments)),

    type: ($) => seq($.identifier, optional(seq(
      token.immediate("["), optional(token.immediate(/[0-9]+/)), token.immediate("]")))),

    // Words with a meaning in one place only are names elsewhere.
    _name: ($) => choice(
      $.identifier,
      alias(choice("where", "version"), $.identifier)),

    // ------------------------------------------------------------------ expressions

    _expression: ($) => choice($._operand, $.object, $.amended_object),

    // An object stands only where an expression begins.
    amended_object: ($) => prec(POSTFIX, seq(
      field("value", choice($.object, $.amended_object)), "with", field("changes", $.record))),

    _operand: ($) => choice(
      $._plain, $.record, $.binary_expression, $.unary_expression,
      $.call_expression, $.index_expression, $.member_expression, $.with_expression),

    // Between `if` or `in` and a block, a brace begins the block.
    _condition: ($) => choice(
      $._plain,
      alias($._condition_binary, $.binary_expression),
      alias($._condition_unary, $.unary_expression),
      alias($._condition_call, $.call_expression),
      alias($._condition_index, $.index_expression),
      alias($._condition_member, $.member_expression),
      alias($._condition_with, $.with_expression)),

    _plain: ($) => choice(
      $.quantity, $.string, $.boolean, $.path, $.list, $.comprehension, $.table, $.tuple,
      $.if_expression),

    binary_expression: ($) => binary($._operand),
    _condition_binary: ($) => binary($._condition),

    unary_expression: ($) => unary($._operand),
    _condition_unary: ($) => unary($._condition),

    call_expression: ($) => call($, $._operand),
    _condition_call: ($) => call($, $._condition),

    index_expression: ($) => index($, $._operand),
    _condition_index: ($) => index($, $._condition),

    member_expression: ($) => member($, $._operand),
    _condition_member: ($) => member($, $._condition),

    with_expression: ($) => amended($, $._operand),
    _condition_with: ($) => amended($, $._condition),

    arguments: ($) => seq("(", optional(list($._argument)), ")"),

    _argument: ($) => choice($.argument, $._expression),

    argument: ($) => seq(field("name", $._name), "=", field("value", $._expression)),

    if_expression: ($) => seq(
      "if", field("condition", $._condition), "{", field("consequence", $._expression), "}",
      repeat(alias($._else_if_expression, $.else_if)),
      "else", "{", field("alternative", $._expression), "}"),

    _else_if_expression: ($) => seq(
      "else", "if", field("condition", $._condition), "{", field("consequence", $._expression), "}"),

    comprehension: ($) => seq(
      "[", "for", $._loop, optional(seq("if", field("filter", $._condition))),
      "=>", field("value", $._expression), "]"),

    list: ($) => seq("[", optional(list($._item)), "]", optional(field("unit", $.unit))),

    tuple: ($) => seq("(", list($._item), ")", optional(field("unit", $.unit))),

    // A list of numbers alone may write a plus before them.
    _item: ($) => choice($._expression, alias($._positive, $.unary_expression)),

    _positive: ($) => seq("+", $.number),

    table: ($) => seq($.table_data, optional(field("unit", $.unit))),

    // One token: it may hold millions of numbers.
    table_data: () => token(seq("#[", /[^\]]*/, "]")),

    record: ($) => seq("{", repeat(seq($.field, optional(choice(",", ";")))), "}"),

    path: ($) => prec.right(POSTFIX + 1, seq($._name, repeat(seq(".", $.identifier)))),

    // ------------------------------------------------------------------ tokens

    quantity: ($) => seq($.number, optional(field("unit", $.unit))),

    number: () => token(seq(
      choice(/[0-9]+(_[0-9]+)*(\.[0-9]+(_[0-9]+)*)?/, /\.[0-9]+(_[0-9]+)*/),
      optional(/[eE][+-]?[0-9]+/))),

    string: ($) => seq(
      "\"", repeat(choice($.string_content, $.escape_sequence)), token.immediate("\"")),

    string_content: () => token.immediate(prec(1, /[^"\\\n]+/)),

    escape_sequence: () => token.immediate(/\\(["\\nt]|u\{[0-9A-Fa-f]{1,6}\})/),

    boolean: () => choice("true", "false"),

    identifier: () => /[A-Za-z_][A-Za-z0-9_]*/,
  },
});

/** Operands joined by operators. */
function binary(operand) {
  const joined = (operator) => seq(
    field("left", operand), field("operator", operator), field("right", operand));
  const levels = BINARY.map((operators, level) => prec.left(level + 1, joined(operators)));
  return choice(...levels, prec.right(POWER, joined("^")));
}

/** A sign before an operand: it applies to an entire power. */
function unary(operand) {
  return prec(UNARY, seq(field("operator", choice("-", "!")), field("operand", operand)));
}

/** An operand, called. */
function call($, operand) {
  return prec.left(POSTFIX, seq(field("function", operand), field("arguments", $.arguments)));
}

/** An item of an operand. */
function index($, operand) {
  return prec.left(POSTFIX, seq(field("value", operand), "[", field("index", $._expression), "]"));
}

/** A field of an operand that is more than a name. */
function member($, operand) {
  return prec.left(POSTFIX, seq(field("value", operand), ".", field("name", $.identifier)));
}

/** An operand, copied with changes. */
function amended($, operand) {
  return prec.left(POSTFIX, seq(field("value", operand), "with", field("changes", $.record)));
}

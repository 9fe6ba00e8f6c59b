; Later patterns count for more, as in Neovim, Helix and tree-sitter's own highlighter.

(identifier) @variable

; Words of the language

[
  "let" "param" "fn" "set" "units" "place" "with" "where" "as" "scene" "use" "plugin" "assert" "expect"
] @keyword

"version" @keyword
["include" "import"] @keyword.import
["for" "in"] @keyword.repeat
["if" "else"] @keyword.conditional
(attribute) @attribute

; What is defined and used

(let_statement name: (identifier) @variable)
(param_statement name: (identifier) @variable.parameter)
(parameter name: (identifier) @variable.parameter)
(fn_statement name: (identifier) @function)
(import_statement name: (identifier) @module)
(type) @type
(expect_statement what: (identifier) @property)

(call_expression function: (path (identifier) @function.call .))
(call_statement function: (path (identifier) @function.call .))
(path . (identifier) @module . (identifier))
(member_expression name: (identifier) @property)

; `category kind "label"`
(object category: (identifier) @type)
(object kind: (kind) @constructor)
(object label: (string) @label)
(place_statement label: (string) @label)

(field name: (identifier) @property)
(argument name: (identifier) @variable.parameter)

; Values

(number) @number
(table_data) @number
(version) @number
(unit) @type.builtin
(boolean) @boolean
(string) @string
(object label: (string) @label)
(place_statement label: (string) @label)
(escape_sequence) @string.escape

[
  "||" "&&" "==" "!=" "<=" ">=" "<" ">" ".." "..=" "+" "-" "*" "/" "%" "^" "!" "=" "=>" "±" "+-"
] @operator

["{" "}" "(" ")" "[" "]"] @punctuation.bracket
["," ";" ":" "."] @punctuation.delimiter

(comment) @comment
(doc) @comment.documentation

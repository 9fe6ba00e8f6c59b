(let_statement name: (identifier) @name) @definition.constant
(param_statement name: (identifier) @name) @definition.constant
(fn_statement name: (identifier) @name) @definition.function
(object label: (string (string_content) @name)) @definition.object
(place_statement label: (string (string_content) @name)) @definition.object

(call_expression function: (path (identifier) @name .)) @reference.call
(call_statement function: (path (identifier) @name .)) @reference.call

[
  (block)
  (fn_statement)
  (for_statement)
  (comprehension)
] @local.scope

(let_statement name: (identifier) @local.definition)
(param_statement name: (identifier) @local.definition)
(parameter name: (identifier) @local.definition)
(for_statement name: (identifier) @local.definition)
(comprehension name: (identifier) @local.definition)
(import_statement name: (identifier) @local.definition)
(fn_statement name: (identifier) @local.definition)

(path . (identifier) @local.reference)

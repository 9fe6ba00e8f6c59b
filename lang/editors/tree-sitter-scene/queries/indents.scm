; Neovim's captures.
[
  (block)
  (record)
  (list)
  (tuple)
  (arguments)
  (parameters)
  (comprehension)
  (if_expression)
] @indent.begin

["}" ")" "]"] @indent.branch @indent.end

(table) @indent.ignore
(comment) @indent.auto

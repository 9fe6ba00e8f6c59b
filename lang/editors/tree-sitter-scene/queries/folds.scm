[
  (block)
  (record)
  (list)
  (tuple)
  (arguments)
  (comprehension)
  (table)
  (if_expression)
  (comment)
] @fold

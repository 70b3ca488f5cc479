(structure
  body: (block) @class.inside) @class.around

(shape_definition
  body: (block) @function.inside) @function.around

(constraint_definition
  body: (constraint_block) @function.inside) @function.around

(function_definition
  value: (_) @function.inside) @function.around

(parameters
  (parameter) @parameter.inside @parameter.around)

(arguments
  (_) @parameter.inside @parameter.around)

(list
  (_) @entry.inside @entry.around)

[
  (line_comment)
  (doc_comment)
  (block_comment)
] @comment.inside

(line_comment)+ @comment.around

(doc_comment)+ @comment.around

(block_comment) @comment.around

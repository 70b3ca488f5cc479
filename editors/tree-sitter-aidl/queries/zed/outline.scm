(structure
  kind: (identifier) @context
  name: (identifier) @name) @item

(shape_definition
  "shape" @context
  name: (identifier) @name) @item

(constraint_definition
  "constraint" @context
  name: (identifier) @name) @item

(function_definition
  "fn" @context
  name: (identifier) @name) @item

(param_declaration
  "param" @context
  name: (identifier) @name) @item

(assignment
  target: (identifier) @name) @item

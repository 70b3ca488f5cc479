(structure
  name: (identifier) @name) @definition.class

(function_definition
  name: (identifier) @name) @definition.function

(shape_definition
  name: (identifier) @name) @definition.class

(constraint_definition
  name: (identifier) @name) @definition.function

(param_declaration
  name: (identifier) @name) @definition.constant

(call_expression
  function: (identifier) @name) @reference.call

(call_expression
  function: (member_expression
    property: (identifier) @name)) @reference.call

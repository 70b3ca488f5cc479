"""The parts of the parser: tables of the grammar, tokens, automaton, nodes, and what goes wrong with them."""

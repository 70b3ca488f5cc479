// x
@note("a\
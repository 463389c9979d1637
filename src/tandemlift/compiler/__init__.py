"""Laws to machine code: the tracer that makes a graph of them, and the compiler of its LLVM text."""

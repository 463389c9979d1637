"""Machine code of LLVM text: compiled in two tiers (`code`), loaded (`machine`) and kept on disk (`store`)."""

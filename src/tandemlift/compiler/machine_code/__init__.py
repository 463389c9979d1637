"""Machine code of LLVM text: compiled in two tiers (`code`), for which machines (`machine`), kept on disk (`store`)."""

"""Many flights that step together from Python (`tl.Block`), and environments of Gymnasium over them."""

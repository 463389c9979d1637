"""The tables of the reference, made from the package; the directive `generated` puts them into the pages."""

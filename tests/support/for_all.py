"""One test for many small cases: a test of its own for each would cost more than it tells."""

import functools
import inspect


def for_all(cases, name=str):
    """Run a test for all cases, its last argument, and name all that fail; the others are fixtures."""

    def made(check):
        def test(**fixtures):
            failed = []
            for case in cases:
                try:
                    check(**fixtures, **{last: case})
                except (AssertionError, LookupError) as error:
                    failed.append(f"{name(case)}: {type(error).__name__}: {error}")
            assert not failed, f"{len(failed)} of {len(cases)}\n" + "\n".join(failed)

        *others, last = inspect.signature(check).parameters
        functools.update_wrapper(test, check)
        del test.__wrapped__  # pytest would ask for a fixture for the case
        test.__signature__ = inspect.Signature([inspect.Parameter(o, inspect.Parameter.KEYWORD_ONLY) for o in others])
        return test

    return made

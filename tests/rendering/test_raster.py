"""Triangles in pixels, beside NumPy, which solves for the weights of all corners in all pixels."""

import numpy as np
import pytest

from tandemlift.rendering.raster import blend, rasterize

SIZES = [(1, 1), (3, 5), (17, 8), (40, 61), (64, 64)]  # also fewer columns than one instruction serves


def drawn(rng, count, size):
    """Random triangles, some far outside the picture, some no wider than a line, one with a NaN."""
    height, width = size
    corners = rng.uniform(-0.6, 1.6, (count, 3, 3)) * [width, height, 1.0]
    corners[::3, :, :2] = corners[::3, :1, :2] + rng.uniform(-4.0, 4.0, (len(corners[::3]), 3, 2))
    corners[::7, 1] = corners[::7, 0]
    corners[count // 2, rng.integers(3)] = np.nan
    return corners


def weights_in(corners, size):
    """(F, H, W, 3) weights of the corners at the centres of pixels; NaN for what is no triangle."""
    rows, columns = np.indices(size) + 0.5
    points = np.stack([columns, rows, np.ones(size)], axis=-1)
    found = np.full((len(corners), *size, 3), np.nan)
    for own, triangle in zip(found, corners, strict=True):
        places = np.vstack([triangle[:, :2].T, np.ones(3)])
        if np.isfinite(triangle).all() and abs(np.linalg.det(places)) > 1e-9:
            own[:] = points @ np.linalg.inv(places).T
    return found


def nearness_in(corners, weights):
    """(F, H, W) nearness; −∞ beside a triangle."""
    near = (weights * corners[:, None, None, :, 2]).sum(axis=-1)
    return np.where((weights >= 0.0).all(axis=-1), near, -np.inf)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("seed", range(4))
def test_every_pixel_shows_the_nearest_triangle(size, seed):
    corners = drawn(np.random.default_rng(seed), 60, size)
    depth, face, weights = np.zeros(size), np.full(size, -1), np.zeros((*size, 2))
    rasterize(corners[:20], depth, face, weights)
    before = depth.copy()
    rasterize(corners, depth, face, weights)
    all_weights = weights_in(corners, size)
    near = nearness_in(corners, all_weights)
    expected = near.argmax(axis=0)
    seen = near.max(axis=0) > 0.0
    np.testing.assert_array_equal(depth > 0.0, seen)
    np.testing.assert_array_equal(face[seen], expected[seen])
    np.testing.assert_array_equal(face[~seen], -1)
    np.testing.assert_allclose(depth[seen], near.max(axis=0)[seen], rtol=1e-9)
    rows, columns = np.nonzero(seen)
    np.testing.assert_allclose(weights[seen], all_weights[expected[seen], rows, columns, 1:], atol=1e-9)
    assert (depth >= before).all()


@pytest.mark.parametrize("size", SIZES)
def test_what_is_seen_through_is_laid_over_the_picture_in_its_order(size):
    rng = np.random.default_rng(5)
    corners, colors = drawn(rng, 30, size), rng.uniform(0.0, 1.0, (30, 4))
    depth, picture = rng.uniform(0.0, 0.8, size), rng.uniform(0.0, 1.0, (*size, 4))
    expected = picture.copy()
    for near, (*color, opacity) in zip(nearness_in(corners, weights_in(corners, size)), colors, strict=True):
        over = (near > depth)[..., None]
        expected = np.where(over, expected + opacity * (np.array([*color, 1.0]) - expected), expected)
    blend(corners, colors, depth, picture)
    np.testing.assert_allclose(picture, expected, rtol=1e-12)


def test_nothing_beside_the_picture_is_written():
    size = (6, 11)
    room = np.zeros((8, 11))
    face, weights = np.zeros((8, 11), np.int64), np.zeros((8, 11, 2))
    corners = np.array([[[-50.0, -50.0, 1.0], [90.0, -50.0, 1.0], [0.0, 120.0, 1.0]]])
    rasterize(corners, room[1:7], face[1:7], weights[1:7])
    assert room[1:7].shape == size
    assert (room[1:7] == 1.0).all()
    assert not room[[0, 7]].any()
    assert not weights[[0, 7]].any()

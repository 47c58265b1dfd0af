import numpy as np
import pytest

from tracker.errors import ModelFileError
from tracker.perception.models.densify import SparseLevel, Sparsity, densify


def _compressed(segments: list[int], indices: list[int]) -> SparseLevel:
    return SparseLevel(0, np.array(segments), np.array(indices))


def test_compressed_rows_are_spread() -> None:
    # Row 0 has column 1, row 1 nothing, row 2 columns 0 and 2.
    layout = Sparsity([0, 1], [], [SparseLevel(3), _compressed([0, 1, 1, 3], [1, 0, 2])])
    dense = densify(np.array([5.0, 6.0, 7.0]), (3, 3), layout)
    np.testing.assert_array_equal(dense, [[0, 5, 0], [0, 0, 0], [6, 0, 7]])


def test_traversal_order_can_put_columns_first() -> None:
    # Column 0 has row 2, column 1 has rows 0 and 1.
    layout = Sparsity([1, 0], [], [SparseLevel(2), _compressed([0, 1, 3], [2, 0, 1])])
    dense = densify(np.array([5.0, 6.0, 7.0]), (3, 2), layout)
    np.testing.assert_array_equal(dense, [[0, 6], [0, 7], [5, 0]])


@pytest.mark.parametrize(
    ("inner_order", "blocks"),
    [
        pytest.param([2, 3], [[1, 2], [3, 4]], id="rows-inside-blocks-first"),
        pytest.param([3, 2], [[1, 3], [2, 4]], id="columns-inside-blocks-first"),
    ],
)
def test_blocks_land_where_the_block_map_says(
    inner_order: list[int], blocks: list[list[int]]
) -> None:
    # Of the 2x2 blocks of a 4x4 matrix, (0, 1), (1, 0) and (1, 1) are stored, in this order.
    layout = Sparsity(
        [0, 1, *inner_order],
        [0, 1],
        [SparseLevel(2), _compressed([0, 1, 3], [1, 0, 1]), SparseLevel(2), SparseLevel(2)],
    )
    block = np.array(blocks)
    expected = np.block([[np.zeros((2, 2)), block], [block + 4, block + 8]])
    np.testing.assert_array_equal(densify(np.arange(1, 13), (4, 4), layout), expected)


def test_blocks_can_cut_one_dimension_only() -> None:
    # Shape (2, 4) with 1x2 blocks: row 0 has the right half, row 1 the left one.
    layout = Sparsity(
        [0, 1, 2], [1], [SparseLevel(2), _compressed([0, 1, 2], [1, 0]), SparseLevel(2)]
    )
    dense = densify(np.array([1, 2, 3, 4]), (2, 4), layout)
    np.testing.assert_array_equal(dense, [[0, 0, 1, 2], [3, 4, 0, 0]])


def test_dense_levels_alone_are_a_reshape() -> None:
    layout = Sparsity([0, 1], [], [SparseLevel(2), SparseLevel(3)])
    dense = densify(np.arange(6), (2, 3), layout)
    np.testing.assert_array_equal(dense, np.arange(6).reshape(2, 3))


def test_values_keep_half_precision() -> None:
    layout = Sparsity([0], [], [_compressed([0, 1], [2])])
    assert densify(np.array([1.5], np.float16), (4,), layout).dtype == np.float16


@pytest.mark.parametrize(
    "layout",
    [
        pytest.param(Sparsity([0, 0], [], []), id="order-is-no-permutation"),
        pytest.param(Sparsity([0], [], [_compressed([0, 2], [0, 1])]), id="too-few-values"),
        pytest.param(Sparsity([0], [], [_compressed([0, 1], [4])]), id="place-outside"),
        pytest.param(Sparsity([0], [], [_compressed([0, 0, 1], [0])]), id="segments-do-not-fit"),
    ],
)
def test_contradictory_layout_is_refused(layout: Sparsity) -> None:
    with pytest.raises(ModelFileError, match="fetch it again"):
        densify(np.array([1.0]), (4,) * max(len(layout.levels), 1), layout)

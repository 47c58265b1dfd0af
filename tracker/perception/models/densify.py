"""How does a sparse TFLite weight become an ordinary array?

TFLite stores a sparse tensor as a tree: one level per dimension in a given traversal order, each
level either dense (every index occurs) or compressed (segments and indices, as in CSR). A
dimension may be cut into blocks; the position inside the block is then a level of its own.

Source: TensorFlow Lite schema, tables SparsityParameters and DimensionMetadata
    (tensorflow/lite/schema/schema.fbs).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tracker.errors import ModelFileError


@dataclass(frozen=True, slots=True, eq=False)
class SparseLevel:
    """One level of the tree.

    Attributes:
        size: Number of indices of a dense level; ignored by a compressed one.
        segments: Of a compressed level, shape (P + 1,): children of parent p are the entries
            segments[p] to segments[p + 1]. None makes the level dense.
        indices: Of a compressed level, shape (segments[-1],): the index of each entry.
    """

    size: int
    segments: NDArray[np.int64] | None = None
    indices: NDArray[np.int64] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Sparsity:
    """How the stored values are laid out.

    Attributes:
        traversal_order: The dimension each level stands for; numbers from the tensor's rank on
            are positions inside blocks.
        block_map: The dimension that each block level cuts, in the order of those numbers.
        levels: One per entry of `traversal_order`.
    """

    traversal_order: Sequence[int]
    block_map: Sequence[int]
    levels: Sequence[SparseLevel]


def densify(
    values: NDArray[np.generic], shape: Sequence[int], sparsity: Sparsity
) -> NDArray[np.generic]:
    """Spread the stored values over an array of zeros.

    Args:
        values: The stored values in traversal order, shape (V,).
        shape: Shape of the dense array.
        sparsity: The layout.

    Returns:
        Array of `shape` and the type of `values`.

    Raises:
        ModelFileError: The layout and the number of values or the shape contradict each other.
    """
    rank = len(shape)
    if sorted(sparsity.traversal_order) != list(range(rank + len(sparsity.block_map))):
        raise ModelFileError(
            f"A sparse weight of shape {tuple(shape)} has traversal order "
            f"{list(sparsity.traversal_order)} and block map {list(sparsity.block_map)}, which do "
            "not fit; the model file is damaged, fetch it again."
        )
    level_of = {dimension: level for level, dimension in enumerate(sparsity.traversal_order)}
    coordinates = _enumerate_leaves(sparsity.levels)

    index = [coordinates[level_of[dimension]] for dimension in range(rank)]
    for block, dimension in enumerate(sparsity.block_map):
        level = level_of[rank + block]
        index[dimension] = index[dimension] * sparsity.levels[level].size + coordinates[level]

    fits = all(not i.size or i.max() < size for i, size in zip(index, shape, strict=True))
    if coordinates.shape[1] != values.size or not fits:
        raise ModelFileError(
            f"A sparse weight of shape {tuple(shape)} names {coordinates.shape[1]} places for "
            f"{values.size} values, or places outside; the model file is damaged, fetch it again."
        )
    dense = np.zeros(tuple(shape), values.dtype)
    dense[tuple(index)] = values
    return dense


def _enumerate_leaves(levels: Sequence[SparseLevel]) -> NDArray[np.int64]:
    """Index of every stored value on every level, shape (levels, values)."""
    paths = np.zeros((0, 1), np.int64)
    for level in levels:
        parents = paths.shape[1]
        if level.segments is None or level.indices is None:
            paths = np.repeat(paths, level.size, axis=1)
            last = np.tile(np.arange(level.size), parents)
        else:
            if level.segments.size != parents + 1:
                raise ModelFileError(
                    f"A sparse weight has {level.segments.size - 1} segments for {parents} "
                    "parents; the model file is damaged, fetch it again."
                )
            paths = np.repeat(paths, np.diff(level.segments), axis=1)
            last = level.indices
        paths = np.vstack([paths, last])
    return paths

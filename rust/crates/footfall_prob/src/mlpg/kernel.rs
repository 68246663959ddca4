//! The inner loops: normal equations, L D Lᵀ and both substitutions, one block of dimensions at a time.

#![expect(
    clippy::inline_always,
    reason = "only what is inlined into the dispatched functions is compiled for their instruction sets"
)]

use multiversion::multiversion;
use multiversion::target::match_target;

use super::lanes::Real;
use super::lanes::sealed::Block as _;
use super::{DimBlock, Layout, Row};
use crate::windows::Windows;

/// Solves one block in f64.
#[multiversion(targets(
    "x86_64+avx512f+avx512vl+avx512bw+avx512dq+avx2+fma",
    "x86_64+avx2+fma",
    "aarch64+neon"
))]
pub(super) fn solve_f64(layout: &Layout, block: &mut DimBlock<'_, f64>) {
    match_target! {
        "x86_64+fma" => solve::<f64, true>(layout, block),
        "aarch64+neon" => solve::<f64, true>(layout, block),
        _ => solve::<f64, false>(layout, block),
    }
}

/// Solves one block in f32.
#[multiversion(targets(
    "x86_64+avx512f+avx512vl+avx512bw+avx512dq+avx2+fma",
    "x86_64+avx2+fma",
    "aarch64+neon"
))]
pub(super) fn solve_f32(layout: &Layout, block: &mut DimBlock<'_, f32>) {
    match_target! {
        "x86_64+fma" => solve::<f32, true>(layout, block),
        "aarch64+neon" => solve::<f32, true>(layout, block),
        _ => solve::<f32, false>(layout, block),
    }
}

/// Solver that is compiled for each instruction set; on its own, the fallback for every target.
#[inline(always)]
pub(super) fn solve<R: Real, const FUSED: bool>(layout: &Layout, block: &mut DimBlock<'_, R>) {
    match layout.windows {
        Windows::Paper => {
            fill_rows::<R, FUSED>(layout, block, [0.25, 0.0625], [0.5, 0.25]);
            factorise::<R, FUSED, true>(layout, block);
            substitute_back::<R, FUSED, 2>(layout, block);
        }
        Windows::Compact => {
            fill_rows::<R, FUSED>(layout, block, [0.25, 1.0], [0.5, 1.0]);
            factorise::<R, FUSED, false>(layout, block);
            substitute_back::<R, FUSED, 1>(layout, block);
        }
    }
}

/// Products that all frames of a row share. `squared` scales the precisions of Δ and Δ² by the
/// smallest product of two of their coefficients, `plain` scales precision x mean by the smallest
/// coefficient, so that the frame loop needs only sums and doublings.
#[inline(always)]
fn fill_rows<R: Real, const FUSED: bool>(
    layout: &Layout,
    block: &mut DimBlock<'_, R>,
    squared: [f64; 2],
    plain: [f64; 2],
) {
    let zero = R::Block::splat(R::default());
    let dim = layout.dim;
    for (row, out) in layout.rows.iter().zip(&mut *block.rows) {
        *out = [zero; 6];
        let Some(state) = row.state else { continue };
        let at = |window: usize| state as usize * 3 * dim + window * dim + block.first_dim;
        let load =
            |table: &[R], window| R::Block::load(&table[at(window)..][..dim - block.first_dim]);
        let precision = load(block.precisions, 0);
        out[0] = precision.add(block.pull_strength);
        out[3] = precision
            .mul(load(block.means, 0))
            .add_mul::<FUSED>(block.pull_strength, block.pull_towards);
        for (window, kept) in [(1, row.keeps_delta), (2, row.keeps_delta_delta)] {
            if kept {
                let precision = load(block.precisions, window);
                let product = precision.mul(load(block.means, window));
                out[window] = precision.mul(R::Block::splat(R::narrow(squared[window - 1])));
                out[3 + window] = product.mul(R::Block::splat(R::narrow(plain[window - 1])));
            }
        }
    }
}

/// Values that a chain of coupled frames carries from one of its frames to the next.
#[derive(Clone, Copy)]
struct Carry<B> {
    /// To subtract from the next pivot, and what of it the one after will need.
    pivot: B,
    pivot_later: B,
    /// To subtract from the next first off-diagonal entry.
    coupling: B,
    /// To subtract from the next right-hand side, and what of it the one after will need.
    rhs: B,
    rhs_later: B,
}

/// One frame's line of the normal equations: entries at lags 0, stride and 2 stride, and the right-hand side.
#[derive(Clone, Copy)]
struct Line<B> {
    diagonal: B,
    near: B,
    far: B,
    rhs: B,
}

/// `rows` are those of frames t - 2 ..= t + 2. Entries 0..3 are scaled precisions, 3..6 scaled precision x mean.
#[inline(always)]
fn paper_line<R: Real>(rows: [&[R::Block; 6]; 5]) -> Line<R::Block> {
    let [before2, before, here, after, after2] = rows;
    let two = |x: R::Block| x.add(x);
    let sides = before[1].add(after[1]);
    let far_sides = before2[2].add(after2[2]);
    let double = two(here[2]);
    Line {
        diagonal: here[0].add(sides).add(far_sides).add(two(double)),
        near: R::Block::splat(R::default()).sub(after[1].add(double.add(two(after2[2])))),
        far: after2[2],
        rhs: here[3]
            .add(before[4].sub(after[4]))
            .add(before2[5].add(after2[5]).sub(two(here[5]))),
    }
}

/// As [`paper_line`] for Δ² = {1, -2, 1}.
#[inline(always)]
fn compact_line<R: Real>(rows: [&[R::Block; 6]; 5]) -> Line<R::Block> {
    let [_, before, here, after, _] = rows;
    let two = |x: R::Block| x.add(x);
    let sides = before[1].add(after[1]);
    let near_sides = before[2].add(after[2]);
    let sum = here[2].add(after[2]);
    Line {
        diagonal: here[0].add(sides).add(near_sides).add(two(two(here[2]))),
        near: R::Block::splat(R::default()).sub(two(sum)),
        far: after[2].sub(after[1]),
        rhs: here[3]
            .add(before[4].sub(after[4]))
            .add(before[5].add(after[5]).sub(two(here[5]))),
    }
}

/// A frame that is given: its couplings act on the right-hand side of later frames, nothing else.
#[inline(always)]
fn fix<R: Real, const FUSED: bool>(
    carry: Carry<R::Block>,
    line: Line<R::Block>,
    value: R::Block,
) -> Carry<R::Block> {
    let zero = R::Block::splat(R::default());
    Carry {
        pivot: zero,
        pivot_later: zero,
        coupling: zero,
        rhs: carry.rhs_later.add_mul::<FUSED>(line.near, value),
        rhs_later: line.far.mul(value),
    }
}

/// L D Lᵀ and forward substitution of one frame: what backward substitution needs, and the new carry.
/// `lowest` collects the smallest pivot.
#[inline(always)]
fn eliminate<R: Real, const FUSED: bool>(
    carry: Carry<R::Block>,
    line: Line<R::Block>,
    lowest: &mut R::Block,
) -> (Carry<R::Block>, [R::Block; 3]) {
    let pivot = line.diagonal.sub(carry.pivot);
    let coupling = line.near.sub(carry.coupling);
    let rhs = line.rhs.sub(carry.rhs);
    *lowest = lowest.min(pivot);
    let inverse = pivot.recip();
    let near = coupling.mul(inverse);
    let far = line.far.mul(inverse);
    let next = Carry {
        pivot: carry.pivot_later.add_mul::<FUSED>(near, coupling),
        pivot_later: far.mul(line.far),
        coupling: far.mul(coupling),
        rhs: carry.rhs_later.add_mul::<FUSED>(near, rhs),
        rhs_later: far.mul(rhs),
    };
    (next, [near, far, rhs.mul(inverse)])
}

/// The rows of five frames, and what they add up to in the middle one.
type Around<'a, R> = [&'a [<R as Real>::Block; 6]; 5];

#[inline(always)]
fn line<R: Real, const PAPER: bool>(around: Around<'_, R>) -> Line<R::Block> {
    if PAPER {
        paper_line::<R>(around)
    } else {
        compact_line::<R>(around)
    }
}

/// Frame t: `entering` is the row of frame t + 2.
#[inline(always)]
fn step<'a, R: Real, const FUSED: bool, const PAPER: bool>(
    around: &mut Around<'a, R>,
    entering: &'a [R::Block; 6],
    carry: &mut Carry<R::Block>,
    factor: &mut [R::Block; 3],
    lowest: &mut R::Block,
) {
    *around = [around[1], around[2], around[3], around[4], entering];
    (*carry, *factor) = eliminate::<R, FUSED>(*carry, line::<R, PAPER>(*around), lowest);
}

#[inline(always)]
fn factorise<R: Real, const FUSED: bool, const PAPER: bool>(
    layout: &Layout,
    block: &mut DimBlock<'_, R>,
) {
    let zero = R::Block::splat(R::default());
    let rows = &*block.rows;
    let n_frames = layout.n_frames;
    let n_fixed = layout.n_fixed;
    // Padded by two at either end, so that every frame has two neighbours.
    let row_of_frame = &layout.row_of_frame[..n_frames + 4];
    let row = |padded: usize| &rows[row_of_frame[padded] as usize];
    let nothing = Carry {
        pivot: zero,
        pivot_later: zero,
        coupling: zero,
        rhs: zero,
        rhs_later: zero,
    };
    let (mut this, mut other) = (nothing, nothing);
    // Beyond four frames back nothing is coupled to the first free frame.
    for t in n_fixed.saturating_sub(4)..n_fixed {
        let frame = &block.trajectory[t * layout.dim..][..layout.dim];
        let value = R::Block::load(&frame[block.first_dim..]);
        let around = [row(t), row(t + 1), row(t + 2), row(t + 3), row(t + 4)];
        let next = fix::<R, FUSED>(this, line::<R, PAPER>(around), value);
        (this, other) = if PAPER { (other, next) } else { (next, other) };
    }
    let mut lowest = block.lowest_pivot;
    let mut around = [
        row(n_fixed),
        row(n_fixed),
        row(n_fixed + 1),
        row(n_fixed + 2),
        row(n_fixed + 3),
    ];
    let entering = &row_of_frame[n_fixed + 4..];
    let factors = &mut block.factors[n_fixed..n_frames];
    if PAPER {
        // Two independent chains, even and odd: in pairs, so that each stays in registers.
        let (pairs, last) = entering.as_chunks::<2>();
        let (factor_pairs, last_factor) = factors.as_chunks_mut::<2>();
        for ([entering, entering2], [factor, factor2]) in pairs.iter().zip(factor_pairs) {
            step::<R, FUSED, PAPER>(
                &mut around,
                &rows[*entering as usize],
                &mut this,
                factor,
                &mut lowest,
            );
            step::<R, FUSED, PAPER>(
                &mut around,
                &rows[*entering2 as usize],
                &mut other,
                factor2,
                &mut lowest,
            );
        }
        for (entering, factor) in last.iter().zip(last_factor) {
            step::<R, FUSED, PAPER>(
                &mut around,
                &rows[*entering as usize],
                &mut this,
                factor,
                &mut lowest,
            );
        }
    } else {
        for (entering, factor) in entering.iter().zip(factors) {
            step::<R, FUSED, PAPER>(
                &mut around,
                &rows[*entering as usize],
                &mut this,
                factor,
                &mut lowest,
            );
        }
    }
    block.lowest_pivot = lowest;
}

#[inline(always)]
fn substitute_back<R: Real, const FUSED: bool, const STRIDE: usize>(
    layout: &Layout,
    block: &mut DimBlock<'_, R>,
) {
    let zero = R::Block::splat(R::default());
    let dim = layout.dim;
    let free = &mut block.trajectory[layout.n_fixed * dim..];
    let factors = &block.factors[layout.n_fixed..layout.n_frames];
    // The four frames after the present one, nearest first.
    let mut after = [zero; 4];
    for (frame, [near, far, rhs]) in free.chunks_exact_mut(dim).zip(factors).rev() {
        let value = rhs
            .sub_mul::<FUSED>(*far, after[2 * STRIDE - 1])
            .sub_mul::<FUSED>(*near, after[STRIDE - 1]);
        value.store(&mut frame[block.first_dim..]);
        after = [value, after[0], after[1], after[2]];
    }
}

impl Row {
    /// Frames outside the sequence: they add nothing.
    pub(super) const NONE: Self = Self {
        state: None,
        keeps_delta: false,
        keeps_delta_delta: false,
    };
}

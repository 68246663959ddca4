//! A cache line of numbers with plain element-wise arithmetic, which the compiler turns into vector
//! instructions of whatever width the target has.

use std::fmt::Debug;

use super::kernel;
use super::{DimBlock, Layout};

/// f32 or f64: the precision in which [`mlpg`](super::mlpg) runs. Sealed.
pub trait Real:
    sealed::Sealed + Copy + Debug + Default + PartialOrd + Send + Sync + 'static
{
    /// One cache line of values.
    #[doc(hidden)]
    type Block: sealed::Block<Self>;
    /// For messages and checks.
    #[doc(hidden)]
    fn widen(self) -> f64;
    /// The nearest representable value.
    #[doc(hidden)]
    fn narrow(value: f64) -> Self;
    /// Solves one block of dimensions with the widest vectors of the machine.
    #[doc(hidden)]
    fn solve(layout: &Layout, block: &mut DimBlock<'_, Self>);
}

pub(super) mod sealed {
    pub trait Sealed {}

    /// Element-wise arithmetic; `FUSED` chooses multiply-add in one rounding, which is fast only
    /// where the hardware has it.
    pub trait Block<R>: Copy + std::fmt::Debug + Send + Sync + 'static {
        const LANES: usize;
        fn splat(value: R) -> Self;
        /// The first values of a slice, and zeros where it has too few.
        fn load(from: &[R]) -> Self;
        /// Writes as many values as there is room for.
        fn store(self, to: &mut [R]);
        fn lanes(&self) -> &[R];
        fn add(self, other: Self) -> Self;
        fn sub(self, other: Self) -> Self;
        fn mul(self, other: Self) -> Self;
        fn recip(self) -> Self;
        /// Lane-wise smaller value; `other` where either is NaN.
        fn min(self, other: Self) -> Self;
        /// self + a * b.
        fn add_mul<const FUSED: bool>(self, a: Self, b: Self) -> Self;
        /// self - a * b.
        fn sub_mul<const FUSED: bool>(self, a: Self, b: Self) -> Self;
    }
}

/// 64 bytes: one AVX-512 register, two of AVX2, four of SSE2 or NEON.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct Lanes<R, const L: usize>([R; L]);

macro_rules! real {
    ($real:ty, $lanes:literal, $solve:path) => {
        impl sealed::Sealed for $real {}

        impl Real for $real {
            type Block = Lanes<$real, $lanes>;

            fn widen(self) -> f64 {
                f64::from(self)
            }

            fn narrow(value: f64) -> Self {
                value as $real
            }

            fn solve(layout: &Layout, block: &mut DimBlock<'_, Self>) {
                $solve(layout, block);
            }
        }

        impl Lanes<$real, $lanes> {
            #[inline(always)]
            fn zip(self, other: Self, f: impl Fn($real, $real) -> $real) -> Self {
                let mut out = self.0;
                for lane in 0..$lanes {
                    out[lane] = f(self.0[lane], other.0[lane]);
                }
                Self(out)
            }

            // Were these inlined, the compiler would copy whole blocks by a call, too, of as many bytes as there are.
            #[cold]
            #[inline(never)]
            fn load_part(from: &[$real]) -> Self {
                let mut out = [0.0; $lanes];
                out[..from.len()].copy_from_slice(from);
                Self(out)
            }

            #[cold]
            #[inline(never)]
            fn store_part(&self, to: &mut [$real]) {
                to.copy_from_slice(&self.0[..to.len()]);
            }
        }

        impl sealed::Block<$real> for Lanes<$real, $lanes> {
            const LANES: usize = $lanes;

            #[inline(always)]
            fn splat(value: $real) -> Self {
                Self([value; $lanes])
            }

            #[inline(always)]
            fn load(from: &[$real]) -> Self {
                match from.first_chunk::<$lanes>() {
                    Some(whole) => Self(*whole),
                    None => Self::load_part(from),
                }
            }

            #[inline(always)]
            fn store(self, to: &mut [$real]) {
                if let Some(whole) = to.first_chunk_mut::<$lanes>() {
                    *whole = self.0;
                } else {
                    self.store_part(to);
                }
            }

            #[inline(always)]
            fn lanes(&self) -> &[$real] {
                &self.0
            }

            #[inline(always)]
            fn add(self, other: Self) -> Self {
                self.zip(other, |a, b| a + b)
            }

            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                self.zip(other, |a, b| a - b)
            }

            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                self.zip(other, |a, b| a * b)
            }

            #[inline(always)]
            fn recip(self) -> Self {
                self.zip(self, |a, _| 1.0 / a)
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                self.zip(other, |a, b| if a < b { a } else { b })
            }

            #[inline(always)]
            fn add_mul<const FUSED: bool>(self, a: Self, b: Self) -> Self {
                let mut out = self.0;
                for lane in 0..$lanes {
                    out[lane] = if FUSED {
                        a.0[lane].mul_add(b.0[lane], out[lane])
                    } else {
                        out[lane] + a.0[lane] * b.0[lane]
                    };
                }
                Self(out)
            }

            #[inline(always)]
            fn sub_mul<const FUSED: bool>(self, a: Self, b: Self) -> Self {
                let mut out = self.0;
                for lane in 0..$lanes {
                    out[lane] = if FUSED {
                        (-a.0[lane]).mul_add(b.0[lane], out[lane])
                    } else {
                        out[lane] - a.0[lane] * b.0[lane]
                    };
                }
                Self(out)
            }
        }
    };
}

real!(f64, 8, kernel::solve_f64);
real!(f32, 16, kernel::solve_f32);

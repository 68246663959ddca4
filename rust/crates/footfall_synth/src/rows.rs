//! Sums of weighted rows, compiled for several instruction sets.

use footfall_prob::mlpg::Real;
use multiversion::multiversion;

/// A precision in which rows are summed.
pub(crate) trait Sum: Real {
    /// Adds four weighted rows.
    fn add_rows(sums: &mut [Self], rows: [(&[Self], Self); 4]);

    /// As [`add_rows`](Self::add_rows), for functions that are compiled for several instruction sets themselves.
    fn add_rows_inline(sums: &mut [Self], rows: [(&[Self], Self); 4]);
}

macro_rules! sum {
    ($real:ty, $add_rows:ident) => {
        #[multiversion(targets("x86_64+avx2"))]
        fn $add_rows(sums: &mut [$real], rows: [(&[$real], $real); 4]) {
            <$real>::add_rows_inline(sums, rows);
        }

        impl Sum for $real {
            fn add_rows(sums: &mut [Self], rows: [(&[Self], Self); 4]) {
                $add_rows(sums, rows);
            }

            // Only what is inlined into a dispatched function is compiled for its instruction set.
            #[inline(always)]
            fn add_rows_inline(sums: &mut [Self], rows: [(&[Self], Self); 4]) {
                let [(a, wa), (b, wb), (c, wc), (d, wd)] = rows;
                for (sum, (((a, b), c), d)) in sums.iter_mut().zip(a.iter().zip(b).zip(c).zip(d)) {
                    *sum += (wa * a + wb * b) + (wc * c + wd * d);
                }
            }
        }
    };
}

sum!(f32, add_rows_f32);
sum!(f64, add_rows_f64);

//! Memory in which no vector of the machine lies across two cache lines: each would take as long as two.

use std::marker::PhantomData;
use std::ops::{Deref, DerefMut};

use bytemuck::{Pod, Zeroable};

/// What a processor fetches at a time.
#[derive(Clone, Copy, Zeroable, Pod)]
#[repr(C, align(64))]
struct Line([u8; 64]);

/// A slice of arrays of numbers, each of whole cache lines, that begins with one.
#[derive(Clone)]
pub(crate) struct Aligned<T> {
    lines: Vec<Line>,
    arrays: PhantomData<T>,
}

impl<T: Pod> Aligned<T> {
    /// So many arrays of zeros.
    pub(crate) fn zeros(count: usize) -> Self {
        const { assert!(size_of::<T>().is_multiple_of(size_of::<Line>())) };
        let lines = count * (size_of::<T>() / size_of::<Line>());
        Self {
            lines: vec![Line::zeroed(); lines],
            arrays: PhantomData,
        }
    }
}

impl<T: Pod> Default for Aligned<T> {
    fn default() -> Self {
        Self::zeros(0)
    }
}

impl<T: Pod> Deref for Aligned<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        bytemuck::cast_slice(&self.lines)
    }
}

impl<T: Pod> DerefMut for Aligned<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        bytemuck::cast_slice_mut(&mut self.lines)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn begins_with_a_cache_line_and_is_zero() {
        for count in [0, 1, 3, 1000] {
            let mut packs = Aligned::<[f64; 8]>::zeros(count);
            assert_eq!(packs.len(), count);
            assert!(packs.as_flattened().iter().all(|&number| number == 0.0));
            assert_eq!(packs.as_ptr().addr() % 64, 0);
            if let Some(last) = packs.last_mut() {
                last[7] = 1.0;
                assert_eq!(packs.as_flattened()[8 * count - 1], 1.0);
            }
        }
    }
}

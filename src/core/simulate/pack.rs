//! Rows of numbers in packs of a fixed width, padded with zeros: what vector units like.

/// Numbers in a pack: one register of the widest machines.
pub(crate) const PACK: usize = 8;
pub(crate) type Pack = [f64; PACK];

/// Packs that a row of `width` numbers takes.
pub(crate) fn packs(width: usize) -> usize {
    width.div_ceil(PACK)
}

/// factor * pack + addend, each number rounded once. By value, so that nothing can alias and a pack is one
/// register.
#[inline(always)]
pub(crate) fn multiply_add(factor: f64, pack: Pack, mut addend: Pack) -> Pack {
    // a loop, not `from_fn`: that may stay a function of its own, compiled for the least of machines
    for i in 0..PACK {
        addend[i] = factor.mul_add(pack[i], addend[i]);
    }
    addend
}

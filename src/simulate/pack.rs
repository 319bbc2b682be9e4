//! Rows of numbers in packs of a fixed width, padded with zeros: what vector units like.

/// Numbers in a pack: one register of the widest machines.
pub const PACK: usize = 8;
pub type Pack = [f64; PACK];

/// Packs that a row of `width` numbers takes.
pub fn packs(width: usize) -> usize {
    width.div_ceil(PACK)
}

/// to += factor * from
#[inline(always)]
pub fn add_scaled(to: &mut [Pack], factor: f64, from: &[Pack]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = plus(*to, scaled(factor, *from));
    }
}

/// By value, so that nothing can alias and a pack is one register.
#[inline(always)]
pub fn scaled(factor: f64, pack: Pack) -> Pack {
    pack.map(|value| factor * value)
}

#[inline(always)]
pub fn plus(a: Pack, b: Pack) -> Pack {
    std::array::from_fn(|i| a[i] + b[i])
}

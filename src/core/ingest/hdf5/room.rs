//! How much may be read of a file.

use super::super::Limits;

/// Beside numbers: what chunks have more than their dataset.
const OVERHEAD: usize = 1 << 24;

/// Bytes that may be read of all datasets together.
pub(super) fn of(limits: &Limits) -> usize {
    let values = limits.max_values.saturating_mul(size_of::<f64>());
    values.saturating_add(OVERHEAD)
}

//! The monomials of a polynomial in some conditions.

/// How many values there are, equal ones counted once.
pub(super) fn distinct(mut values: Vec<f64>) -> u32 {
    values.sort_by(f64::total_cmp);
    // zeros of both signs are one value
    values.dedup_by(|a, b| *a == *b);
    u32::try_from(values.len()).unwrap_or(u32::MAX)
}

/// The powers of all monomials up to a degree, the constant first, with no condition to a higher power than `most` of it.
pub(super) fn powers(most: &[u32], degree: usize) -> Vec<Vec<u32>> {
    let conditions = most.len();
    let mut all = vec![vec![0; conditions]];
    let mut last = all.clone();
    for _ in 0..degree {
        let mut next: Vec<Vec<u32>> = Vec::new();
        for powers in &last {
            for condition in 0..conditions {
                let mut more = powers.clone();
                more[condition] += 1;
                if more[condition] <= most[condition] && !next.contains(&more) {
                    next.push(more);
                }
            }
        }
        all.extend(next.clone());
        last = next;
    }
    all
}

/// `1`, `alpha`, `alpha*mach`, `alpha^2`.
pub(super) fn term_name(names: &[String], powers: &[u32]) -> String {
    let factor = |(name, power): (&String, &u32)| match power {
        0 => None,
        1 => Some(name.clone()),
        power => Some(format!("{name}^{power}")),
    };
    let factors: Vec<String> = names.iter().zip(powers).filter_map(factor).collect();
    match factors.is_empty() {
        true => "1".to_string(),
        false => factors.join("*"),
    }
}

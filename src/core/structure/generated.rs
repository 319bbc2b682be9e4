//! Terms that are made of variables: all their powers and products up to an order.

/// Most terms of one search.
pub const MOST_TERMS: usize = 500;

/// By order, then in the order of the variables: `alpha`, `q`, `alpha^2`, `alpha*q`, `q^2`, ... `None` where these are more than
/// [`MOST_TERMS`].
pub fn polynomials(variables: &[String], order: usize) -> Option<Vec<String>> {
    let mut terms = Vec::new();
    for total in 1..=order {
        add(variables, total, &mut Vec::new(), &mut terms)?;
    }
    Some(terms)
}

/// Adds the terms of a total order, given the powers of the first variables.
fn add(
    variables: &[String],
    total: usize,
    powers: &mut Vec<usize>,
    terms: &mut Vec<String>,
) -> Option<()> {
    if powers.len() + 1 >= variables.len() {
        powers.push(total);
        terms.push(written(variables, powers));
        powers.pop();
        return (terms.len() <= MOST_TERMS).then_some(());
    }
    for power in (0..=total).rev() {
        powers.push(power);
        add(variables, total - power, powers, terms)?;
        powers.pop();
    }
    Some(())
}

fn written(variables: &[String], powers: &[usize]) -> String {
    let factors = variables
        .iter()
        .zip(powers)
        .filter(|(_, power)| **power > 0);
    let factors: Vec<String> = factors
        .map(|(variable, power)| match power {
            1 => variable.clone(),
            _ => format!("{variable}^{power}"),
        })
        .collect();
    factors.join("*")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_products_up_to_an_order_are_made_once() {
        let names =
            |names: &[&str]| -> Vec<String> { names.iter().map(ToString::to_string).collect() };
        let terms = polynomials(&names(&["a", "q"]), 2).unwrap();
        assert_eq!(terms, ["a", "q", "a^2", "a*q", "q^2"]);
        assert_eq!(polynomials(&names(&["a"]), 3).unwrap(), ["a", "a^2", "a^3"]);
        // (3 + 4)!/(3! 4!) less the constant
        let many = polynomials(&names(&["a", "q", "d"]), 4).unwrap();
        assert_eq!(many.len(), 34);
        let distinct: std::collections::BTreeSet<&String> = many.iter().collect();
        assert_eq!(distinct.len(), 34);
        assert!(polynomials(&vec!["x".to_string(); 30], 8).is_none());
    }
}

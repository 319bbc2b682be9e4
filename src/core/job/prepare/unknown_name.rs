//! A name in a spec that the model does not have.

use crate::flight::{Fault, escape};

/// Names that are told of one kind: each comes with all that are known, and a spec has room for very many.
const TOLD: usize = 20;

/// Adds the fault at `pointer`/`name`; `what` the name was to be, and which of that kind there are.
pub(super) fn unknown_name<'n>(
    pointer: &str,
    code: &'static str,
    (what, name): (&str, &str),
    known: impl Iterator<Item = &'n str>,
    faults: &mut Vec<Fault>,
) {
    if faults.iter().filter(|fault| fault.code == code).count() >= TOLD {
        return;
    }
    let known: Vec<&str> = known.collect();
    let has = match known.is_empty() {
        true => "none".to_string(),
        false => known.join(", "),
    };
    let message = format!("the model has no {what} '{name}'; it has {has}");
    let pointer = format!("{pointer}/{}", escape(name));
    faults.push(Fault::new(pointer, code, message));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_first_of_very_many_are_told() {
        let mut faults = Vec::new();
        for i in 0..1000 {
            let (what, name) = ("parameter", format!("p{i}"));
            let known = ["Za", "Zq"].into_iter();
            unknown_name(
                "/parameters",
                "unknown_parameter",
                (what, &name),
                known,
                &mut faults,
            );
        }
        assert_eq!(faults.len(), TOLD);
        assert_eq!(faults[19].pointer, "/parameters/p19");
        let message = "the model has no parameter 'p19'; it has Za, Zq";
        assert_eq!(faults[19].message, message);
    }
}

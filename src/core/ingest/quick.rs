//! Numbers as most files have them, read fast: the same result as of the standard library's reader.

/// Powers of ten that a double holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// The number at the beginning of a line's rest, and its length with the blanks around it. It ends at the delimiter or the
/// line's end. `None` where it takes more than whole numbers below 2^53 and exact powers of ten: the result is the one of
/// [`number`], found faster.
#[inline]
pub(super) fn quick_number(bytes: &[u8], delimiter: u8, point: u8) -> Option<(f64, usize)> {
    let mut at = blanks(bytes);
    let is_negative = sign(bytes, &mut at);
    let (mut mantissa, mut digits) = whole(bytes, &mut at, 0);
    let mut fraction = 0;
    if bytes.get(at) == Some(&point) {
        at += 1;
        (mantissa, fraction) = whole(bytes, &mut at, mantissa);
        digits += fraction;
    }
    if digits == 0 || digits > 18 || mantissa > (1 << 53) {
        return None;
    }
    let mut exponent = -(fraction as i64);
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        at += 1;
        let is_below_one = sign(bytes, &mut at);
        let (power, digits) = whole(bytes, &mut at, 0);
        if digits == 0 || digits > 3 {
            return None;
        }
        exponent += if is_below_one {
            -(power as i64)
        } else {
            power as i64
        };
    }
    at += blanks(&bytes[at..]);
    if bytes.get(at).is_some_and(|&byte| byte != delimiter) {
        return None;
    }
    let power = *POWERS.get(exponent.unsigned_abs() as usize)?;
    let value = if exponent < 0 {
        mantissa as f64 / power
    } else {
        mantissa as f64 * power
    };
    Some((if is_negative { -value } else { value }, at))
}

fn blanks(bytes: &[u8]) -> usize {
    bytes.iter().take_while(|&&byte| byte == b' ').count()
}

/// Whether it is a minus; a sign is passed over.
#[inline]
fn sign(bytes: &[u8], at: &mut usize) -> bool {
    let sign = bytes.get(*at).filter(|byte| matches!(byte, b'+' | b'-'));
    *at += usize::from(sign.is_some());
    sign == Some(&b'-')
}

/// Digits put behind those of `before`, and how many; past 18 they may have overflown.
#[inline]
fn whole(bytes: &[u8], at: &mut usize, before: u64) -> (u64, usize) {
    let begin = *at;
    let mut number = before;
    while let Some(digit) = (bytes.get(*at).map(|byte| byte.wrapping_sub(b'0'))).filter(|&d| d < 10)
    {
        number = number.wrapping_mul(10).wrapping_add(u64::from(digit));
        *at += 1;
    }
    (number, *at - begin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quick_way_leads_to_the_same_number() {
        let quick = |text: &str| quick_number(text.as_bytes(), b',', b'.');
        for text in [
            "0",
            "-1.0000",
            "3.0014",
            "1e5",
            "1.5e-3",
            "9007199254740991",
            "0.1",
            "123456.789012",
            ".5",
            "5.",
            "-0",
            "1E+22",
        ] {
            let (value, length) = quick(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(
                value.to_bits(),
                text.parse::<f64>().unwrap().to_bits(),
                "{text}"
            );
            assert_eq!(length, text.len());
        }
        assert_eq!(quick(" 1.5 ,2"), Some((1.5, 5)));
        for text in [
            "",
            "-",
            ".",
            "x",
            "1x",
            "1e",
            "1e9999",
            "nan",
            "1.2.3",
            "\"1\"",
            "12345678901234567890",
            "1 2",
        ] {
            assert_eq!(quick(text), None, "{text}");
        }
    }
}

//! Numbers as text.

/// A number with digits after the point; never minus zero, whose sign would be that of rounding.
pub fn number(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    if text.bytes().any(|digit| (b'1'..=b'9').contains(&digit)) {
        text
    } else {
        text.trim_start_matches('-').to_owned()
    }
}

/// A number with its sign, unless it is rounded to zero.
pub fn signed(value: f64, digits: usize) -> String {
    let text = number(value, digits);
    let zero = text.bytes().all(|byte| byte == b'0' || byte == b'.');
    if zero || value < 0.0 { text } else { format!("+{text}") }
}

/// Four significant digits.
pub fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return number(value, 0);
    }
    let magnitude = magnitude(value);
    if (-3..6).contains(&magnitude) {
        number(value, usize::try_from(3 - magnitude).unwrap_or_default())
    } else {
        format!("{value:.3e}")
    }
}

/// Two significant digits, or all before the point.
pub fn two_digits(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        value if (0.01..1e4).contains(&value) => {
            number(value, usize::try_from(1 - magnitude(value)).unwrap_or_default())
        }
        value => format!("{value:.0e}"),
    }
}

/// The power of ten of the first digit.
pub fn magnitude(value: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "at most 308")]
    let magnitude = value.abs().log10().floor() as i32;
    magnitude
}

/// A signed percentage.
pub fn percent(value: f64) -> String {
    format!("{} %", signed(value, 2))
}

/// How far a value is from the published one.
pub fn deviation(value: f64, published: f64) -> String {
    percent(100.0 * (value / published - 1.0))
}

/// A time in a unit that fits, to the nanosecond below a second.
pub fn seconds(time: f64) -> String {
    match time.abs() {
        size if size >= 1.0 => format!("{time:.3} s"),
        size if size >= 1e-3 => format!("{:.4} ms", 1e3 * time),
        _ => format!("{:.3} us", 1e6 * time),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_with_signs_that_mean_something() {
        assert_eq!(number(-0.004, 2), "0.00");
        assert_eq!(number(-0.006, 2), "-0.01");
        assert_eq!(signed(0.004, 2), "0.00");
        assert_eq!(signed(0.006, 2), "+0.01");
        assert_eq!(significant(1354.515), "1355");
        assert_eq!(significant(0.026_954), "0.02695");
        assert_eq!(significant(3.54e6), "3.540e6");
        assert_eq!(deviation(0.9, 1.0), "-10.00 %");
        assert_eq!(two_digits(0.0123), "0.012");
        assert_eq!(two_digits(347.6), "348");
        assert_eq!(seconds(0.005_34), "5.3400 ms");
    }
}

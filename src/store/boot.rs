//! A clock that nobody sets: the time since the machine was started, the same for all processes on it.

use std::fs::read_to_string;
use std::sync::OnceLock;

/// Which start of the machine this is; `None` where the system does not tell.
pub(super) fn id() -> Option<&'static str> {
    static ID: OnceLock<Option<String>> = OnceLock::new();
    let id = ID.get_or_init(|| {
        let id = read_to_string("/proc/sys/kernel/random/boot_id").ok()?;
        let plain = |byte: u8| byte.is_ascii_hexdigit() || byte == b'-';
        let id = id.trim();
        // it goes into a pattern
        (!id.is_empty() && id.bytes().all(plain)).then(|| id.to_string())
    });
    id.as_deref()
}

/// Milliseconds since the machine was started, sleep included.
pub(super) fn milliseconds() -> Option<i64> {
    let uptime = read_to_string("/proc/uptime").ok()?;
    let seconds: f64 = uptime.split_whitespace().next()?.parse().ok()?;
    Some((seconds * 1000.0) as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_goes_on_and_says_which_start_it_counts_from() {
        let before = milliseconds().expect("Linux");
        std::thread::sleep(std::time::Duration::from_millis(50));
        let after = milliseconds().expect("Linux");
        // it is told to 10 ms
        assert!((30..5000).contains(&(after - before)), "{before} {after}");
        assert_eq!(id().expect("Linux").len(), 36);
    }
}

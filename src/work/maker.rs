//! This program, as a result names what made it.

use std::fs::File;
use std::sync::OnceLock;

use sha2::{Digest, Sha256};

use crate::job::Maker;

/// Looked up once; it reads the program file, and so is not for the reactor's threads.
pub(super) fn this_program() -> &'static Maker {
    static MAKER: OnceLock<Maker> = OnceLock::new();
    MAKER.get_or_init(|| Maker {
        version: env!("CARGO_PKG_VERSION").to_string(),
        program: digest().unwrap_or_else(|error| {
            tracing::warn!(%error, "the program file cannot be read; results do not name it");
            "unknown".to_string()
        }),
        architecture: std::env::consts::ARCH.to_string(),
        vector_instructions: vector_instructions().to_string(),
    })
}

fn digest() -> std::io::Result<String> {
    // by this name the file is found that runs, even if another was put in its place since
    let mut program =
        File::open("/proc/self/exe").or_else(|_| File::open(std::env::current_exe()?))?;
    let mut digest = Sha256::new();
    let mut chunk = vec![0; 1 << 20];
    loop {
        match std::io::Read::read(&mut program, &mut chunk)? {
            0 => return Ok(hex::encode(digest.finalize())),
            length => digest.update(&chunk[..length]),
        }
    }
}

/// As `model` and `estimate` choose them.
#[cfg(target_arch = "x86_64")]
fn vector_instructions() -> &'static str {
    use std::arch::is_x86_feature_detected as has;
    if !(has!("avx2") && has!("fma")) {
        "sse2"
    } else if has!("avx512f") && has!("avx512dq") && has!("avx512vl") {
        "avx512+fma"
    } else {
        "avx2+fma"
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn vector_instructions() -> &'static str {
    "the target's"
}

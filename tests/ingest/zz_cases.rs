use trimtab_core::ingest::{Format, Limits, Mapping, read_recording};

#[test]
fn cases() {
    let mut dirs: Vec<_> = std::fs::read_dir("/work/shared/cases")
        .unwrap()
        .map(|d| d.unwrap().path())
        .collect();
    dirs.sort();
    for dir in dirs {
        let mapping = std::fs::read_to_string(dir.join("mapping.toml")).ok();
        let mut files: Vec<_> = std::fs::read_dir(&dir)
            .unwrap()
            .map(|d| d.unwrap().path())
            .collect();
        files.sort();
        for file in files {
            let name = file.to_string_lossy().replace("/work/shared/cases/", "");
            let ext = file
                .extension()
                .and_then(|e| e.to_str())
                .unwrap_or("")
                .to_string();
            if !["csv", "asc"].contains(&ext.as_str()) {
                continue;
            }
            let bytes = std::fs::read(&file).unwrap();
            let format = Format::from_extension(&ext).unwrap();
            for with in [false, true] {
                if with && mapping.is_none() {
                    continue;
                }
                let m = mapping
                    .as_ref()
                    .filter(|_| with)
                    .map(|t| Mapping::from_toml(t));
                let m = match m {
                    Some(Err(e)) => {
                        println!("{name} with mapping: MAPPING {e}");
                        continue;
                    }
                    Some(Ok(m)) => Some(m),
                    None => None,
                };
                let what = if with { "with mapping" } else { "as it is" };
                match read_recording(&bytes, format, None, m.as_ref(), &Limits::default()) {
                    Ok(r) => {
                        let ch: Vec<String> = r
                            .maneuver
                            .channels()
                            .iter()
                            .map(|(n, c)| format!("{n}[{}]", c.recorded_unit))
                            .collect();
                        println!(
                            "{name} {what}: {} samples {:.3} s; {}",
                            r.maneuver.len(),
                            r.maneuver.duration(),
                            ch.join(" ")
                        );
                        for f in r.findings {
                            println!("      {}: {}", f.code, f.message);
                        }
                    }
                    Err(e) => {
                        println!("{name} {what}: REFUSED {e}");
                        if let Some(d) = e.draft() {
                            println!("      draft: {}", &d[..d.len().min(200)]);
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn speed() {
    for (name, delimiter, comma) in [
        ("commas", ',', false),
        ("semicolons, decimal commas", ';', true),
        ("blanks", ' ', false),
    ] {
        let mut text = String::from("t[s]");
        for k in 0..15 {
            text += &format!("{delimiter}c{k}[deg]");
        }
        text.push('\n');
        let mut x = 1u64;
        for row in 0..100_000 {
            let mut line = format!("{:.3}", row as f64 * 0.01);
            for _ in 0..15 {
                x = x
                    .wrapping_mul(6364136223846793005)
                    .wrapping_add(1442695040888963407);
                line += &format!("{delimiter}{:.5}", ((x >> 40) as f64 / 1e6) - 8.0);
            }
            line.push('\n');
            if comma {
                line = line.replace('.', ",");
            }
            text += &line;
        }
        for _ in 0..3 {
            let begun = std::time::Instant::now();
            let m = trimtab_core::ingest::read(text.as_bytes(), Format::Csv, &Limits::default())
                .unwrap();
            let s = begun.elapsed().as_secs_f64();
            println!(
                "{name}: {:.0} MB, {} samples, {:.0} MB/s",
                text.len() as f64 / 1e6,
                m.len(),
                text.len() as f64 / 1e6 / s
            );
        }
    }
}

//! Figures as files, what is drawn in them, and reports on paper, in a real browser.

use super::browser::{finished, flights, go, idle, is_drawn, over, work};
use super::compare::looks_well;
use crate::common::browser::{Browser, browse};
use crate::common::jobs::job;
use crate::common::recordings::elevator;
use crate::common::server::Server;
use crate::flown::patch;
use serde_json::json;

/// What a button saves, as text; of a picture in PNG its first bytes as letters.
async fn saved(browser: &Browser, figure: &str, what: &str) -> String {
    browser
        .run("window.saved = undefined; URL.createObjectURL = blob => { blob.text().then(text => { window.saved = text; }); return location.href + '#'; }; HTMLAnchorElement.prototype.click = () => {};")
        .await;
    browser.click(&format!("{figure} [data-save={what}]")).await;
    let text = browser.until("window.saved").await;
    text.as_str().unwrap().to_string()
}

#[tokio::test]
async fn figures_are_saved_as_pictures_and_tables() {
    browse("saved figures", async |browser| {
        let server = Server::start().await;
        let id = finished(&server, "to be saved", &[], &elevator()).await;
        go(browser, &server, &format!("/jobs/{id}")).await;
        is_drawn(browser).await;
        browser.dark(true).await;
        is_drawn(browser).await;
        let histories = "#histories-plots figure";
        let svg = saved(browser, histories, "svg").await;
        assert!(
            svg.starts_with("<svg")
                && svg.contains("alpha, deg")
                && svg.contains("residual, deg/s"),
            "{}",
            &svg[..300]
        );
        // for paper, though the page is dark
        assert!(
            svg.contains("rgb(255, 255, 255)") && svg.contains("rgb(26, 32, 39)"),
            "{}",
            &svg[..2000]
        );
        assert!(saved(browser, histories, "png").await.contains("PNG"));
        let csv = saved(browser, histories, "csv").await;
        let mut lines = csv.lines();
        let header: Vec<&str> = lines
            .next()
            .unwrap()
            .split("\",\"")
            .flat_map(|part| part.split(",\""))
            .collect();
        assert!(header.len() > 6, "{csv}");
        // a row for each sample, as the API has them, in the units of the figure
        let told = server
            .get(&format!("/v1/jobs/{id}/time-histories"))
            .await
            .json();
        let segment = &told["segments"][0];
        assert_eq!(
            lines.clone().count(),
            segment["time"].as_array().unwrap().len()
        );
        let row: Vec<f64> = lines
            .nth(40)
            .unwrap()
            .split(',')
            .map(|cell| cell.parse().unwrap())
            .collect();
        let alpha = segment["outputs"]
            .as_array()
            .unwrap()
            .iter()
            .find(|of| of["name"] == "alpha")
            .unwrap();
        let expected = alpha["model"][40].as_f64().unwrap().to_degrees();
        assert!((row[0] - segment["time"][40].as_f64().unwrap()).abs() < 1e-12);
        assert!(
            row.iter().any(|value| (value - expected).abs() < 1e-9),
            "{expected}: {row:?}"
        );
        // those that the server draws
        let svg = saved(browser, "[data-name=eigenvalues]", "svg").await;
        assert!(
            svg.starts_with("<svg") && !svg.contains("var(") && !svg.contains("currentColor"),
            "{svg}"
        );
        assert!(
            saved(browser, "[data-name=eigenvalues]", "png")
                .await
                .contains("PNG")
        );
        let csv = saved(browser, "[data-name=eigenvalues]", "csv").await;
        assert!(
            csv.starts_with("name,real[1/s],real_standard_error[1/s],"),
            "{csv}"
        );
        assert_eq!(
            csv.lines().count() as u64,
            1 + browser.count("svg.plane path").await
        );
        let csv = saved(browser, "figure:has(#cost)", "csv").await;
        assert!(csv.starts_with("iteration,"), "{csv}");
    })
    .await;
}

#[tokio::test]
async fn measured_dots_lie_above_lines_and_colours_differ() {
    browse("order of drawing", async |browser| {
        let server = Server::start().await;
        let uses = flights(&server).await;
        let id = server.submit(&json!({"kind": "diagnose", "model": "short-period", "maneuvers": uses})).await;
        server.wait(&id).await;
        go(browser, &server, &format!("/jobs/{id}")).await;
        is_drawn(browser).await;
        let plot = "document.querySelector('#histories-plots .plot')";
        let names = format!("JSON.stringify({plot}.data.filter(series => series.yaxis === 'y').map(series => series.name))");
        assert_eq!(browser.until(&names).await, r#"["declared model","model with the effects","measured"]"#);
        let colours = format!("new Set(['declared model', 'model with the effects', 'input', 'residual'].map(name => {plot}.data.find(series => series.name === name).line.color)).size");
        assert_eq!(browser.until(&colours).await, 4);
        // what the effect explains is seen on the flight that took no part in any decision
        browser.says("figure:has([aria-label^='residuals of final'])", "final test").await;
        let rms = |name: &str| format!("(values => Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / values.length))(document.querySelector('#explained .plot').data.find(series => series.name === {name:?}).y)");
        let before = browser.until(&rms("residual of the declared model")).await.as_f64().unwrap();
        let after = browser.until(&rms("residual")).await.as_f64().unwrap();
        let told = server.get(&format!("/v1/jobs/{id}/diagnosis")).await.json();
        let fit = told["fits"].as_array().unwrap().iter().find(|fit| fit["role"] == "final").unwrap();
        for (drawn, of) in [(before, "before"), (after, "after")] {
            let rms = fit[of]["rms"].as_f64().unwrap().to_degrees();
            assert!((drawn / rms - 1.0).abs() < 1e-6, "{of}: {drawn} {rms}");
        }
        // the effect first, with its size; then the errors, those of the final test first
        let story = browser.text("[aria-labelledby=diagnosis]").await;
        let size = told["effects"][0]["parameters"][0]["estimate"].as_f64().unwrap().to_degrees();
        let verdict = browser.text(".verdict").await;
        assert!(verdict.starts_with("Found: there is play (backlash) behind de") && verdict.contains(&format!("{size:.4}")), "{size}: {verdict}");
        let places = ["Found: ", "Errors before and after", "final test", "What the effects explain", "Refused candidates"].map(|part| story.find(part).unwrap_or_else(|| panic!("{part}: {story}")));
        assert!(places.is_sorted(), "{places:?}: {story}");
        assert_eq!(browser.count("[aria-labelledby=diagnosis] details[open]").await, 0);
        looks_well(browser, "diagnosis").await;
        // in the list it is one short line
        go(browser, &server, "/").await;
        let outcome = browser.text("#jobs tbody td.words").await;
        assert!(outcome.starts_with("there is play") && outcome.len() < 100 && !outcome.contains("RMS"), "{outcome}");
        looks_well(browser, "list").await;
    })
    .await;
}

#[tokio::test]
async fn no_line_crosses_a_gap() {
    browse("gap", async |browser| {
        let server = idle().await;
        let times = (0..50).map(|k| 0.1 * f64::from(k));
        let times: Vec<f64> = times
            .chain((0..30).map(|k| 9.0 + 0.1 * f64::from(k)))
            .collect();
        let rows: String = times
            .iter()
            .map(|t| format!("{t:.1},{}\n", t.sin()))
            .collect();
        let id = server.upload(&format!("t[s],alpha[deg]\n{rows}")).await;
        go(browser, &server, &format!("/maneuvers/{id}")).await;
        browser.find("#maneuver .plot .main-svg").await;
        is_drawn(browser).await;
        let values = "document.querySelector('.plot').data[0].y";
        // behind the 50th sample
        assert_eq!(
            browser
                .until(&format!("{values}.findIndex(value => value === null)"))
                .await,
            50
        );
        assert_eq!(browser.until(&format!("{values}.length")).await, 81);
        browser.picture("maneuver").await;
        let csv = saved(browser, "#maneuver", "csv").await;
        assert_eq!(csv.lines().count(), 1 + times.len(), "{csv}");
        let line: Vec<f64> = csv
            .lines()
            .nth(51)
            .unwrap()
            .split(',')
            .map(|cell| cell.parse().unwrap())
            .collect();
        assert!(
            (line[0] - 9.0).abs() < 1e-12 && (line[1] - 9f64.sin()).abs() < 1e-9,
            "{line:?}"
        );
    })
    .await;
}

#[tokio::test]
async fn a_job_that_waits_says_where_and_a_search_how_far_it_is() {
    browse("live", async |browser| {
        let server = idle().await;
        server.submit(&job(&server.upload(&elevator()).await)).await;
        let uses = flights(&server).await;
        let spec = json!({"kind": "diagnose", "model": "short-period", "maneuvers": uses});
        let id = server.submit(&spec).await;
        assert_eq!(server.get(&format!("/v1/jobs/{id}")).await.json()["ahead"], 1);
        go(browser, &server, &format!("/jobs/{id}")).await;
        browser.says("#elapsed", "1 job is before it in the queue").await;
        browser.is_accessible().await;
        browser.picture("queued").await;
        // what the page said is kept, for it may be over soon
        browser
            .run("window.stayed = []; new MutationObserver(() => window.stayed.push(document.querySelector('#way').textContent + '|' + document.querySelector('#elapsed').textContent)).observe(document.querySelector('#job'), {subtree: true, childList: true, characterData: true}); addEventListener('pagehide', () => sessionStorage.setItem('told', JSON.stringify(window.stayed)));")
            .await;
        let _work = work(&server);
        over(browser, &server, &id).await;
        let told = browser.until("sessionStorage.getItem('told')").await;
        let told = told.as_str().unwrap();
        for part in ["candidates fitted, round 1 of at most 6", "candidates fitted, round 2 of at most 6"] {
            assert!(told.contains(part), "{part}: {told}");
        }
        assert!(server.get(&format!("/v1/jobs/{id}")).await.json().get("ahead").is_none());
    })
    .await;
}

#[tokio::test]
async fn a_report_is_whole_on_paper() {
    browse("report on paper", async |browser| {
        let server = Server::start().await;
        let mut spec = job(&server.upload(&elevator()).await);
        spec["name"] = json!("a \"title\" with </style> in it");
        spec["maneuvers"][0]["label"] = json!("doublet");
        spec["maneuvers"][0]["seconds"] = json!([1.0, 20.0]);
        let id = server.submit(&spec).await;
        assert_eq!(server.wait(&id).await["status"], "succeeded");
        let path = server.get("/v1/maneuvers").await.json();
        let recording = path["maneuvers"][0]["id"].as_str().unwrap().to_string();
        let what = json!({"flown": {"registration": "D-ADAM", "test_point": "12a"}});
        let said = patch(&server, &recording, &what).await;
        assert_eq!(said.status, 200, "{}", said.text());
        go(browser, &server, &format!("/jobs/{id}/report")).await;
        let report = browser.text("main").await;
        for part in [
            "State equations", "Output equations", "Recordings", "1 to 20 s", "D-ADAM", "12a", "Channels",
            "the channel of this name", "Method", "output error", "levenberg marquardt", "rk4", "halving the steps",
            "independent between outputs", "Noise of the outputs", "standard deviation", "SHA-256", "Approved by",
        ] {
            assert!(report.contains(part), "{part}: {report}");
        }
        assert!(browser.count("math").await > 4);
        let rules = "[...document.styleSheets[0].cssRules].filter(rule => rule instanceof CSSPageRule).map(rule => rule.cssText).join('\\n')";
        let rules = browser.until(rules).await;
        let rules = rules.as_str().unwrap();
        assert!(rules.contains("counter(page)"), "{rules}");
        assert!(rules.contains(r#"a \"title\" with </style> in it"#), "{rules}");
        // on a sheet of A4 nothing is cut at the side
        browser.print(true).await;
        browser.resize(680, 1000).await;
        browser.fits().await;
        let cut = "[...document.querySelectorAll('table, math, svg')].filter(one => one.getBoundingClientRect().right > innerWidth + 1).map(one => one.parentElement.textContent.slice(0, 80))";
        assert_eq!(browser.run(&format!("return {cut}")).await, json!([]));
        browser.picture("paper").await;
        browser.print(false).await;
        looks_well(browser, "screen").await;
    })
    .await;
}

//! Jobs side by side, in a real browser.

use super::browser::{finished, go, is_drawn};
use crate::common::browser::{Browser, browse};
use crate::common::recordings::elevator_of;
use crate::common::server::Server;

/// Light, dark and narrow: accessible, nothing wider than the page.
pub(super) async fn looks_well(browser: &Browser, name: &str) {
    for dark in [false, true] {
        browser.dark(dark).await;
        is_drawn(browser).await;
        browser.is_accessible().await;
        browser
            .picture(&format!("{name}-{}", if dark { "dark" } else { "light" }))
            .await;
    }
    browser.resize(390, 844).await;
    is_drawn(browser).await;
    browser.fits().await;
    browser.picture(&format!("{name}-narrow")).await;
    browser.resize(1300, 900).await;
    browser.dark(false).await;
}

#[tokio::test]
async fn jobs_are_ticked_and_compared() {
    browse("compare", async |browser| {
        let server = Server::start().await;
        let csv = elevator_of(16.0, 1);
        let ids = [
            finished(&server, "first flight", &["alpha=2", "flaps=up"], &csv).await,
            finished(&server, "second flight", &["alpha=5", "flaps=up"], &elevator_of(16.0, 2)).await,
            finished(&server, "first flight again", &["alpha=2", "flaps=down"], &csv).await,
        ];
        go(browser, &server, "/").await;
        let tick = |id: &str| format!("[data-tick={id:?}]");
        browser.click(&tick(&ids[0])).await;
        browser.says("#ticked", "tick another").await;
        browser.click(&tick(&ids[1])).await;
        browser.says("#ticked", "2 jobs are ticked").await;
        // they stay ticked when the list is made anew, and in another search
        go(browser, &server, "/?q=again").await;
        browser.says("#ticked", "2 jobs are ticked").await;
        browser.click(&tick(&ids[2])).await;
        go(browser, &server, "/").await;
        browser.until("document.querySelectorAll('[data-tick]:checked').length === 3").await;
        // all at once, and none
        browser.click("#tick-all").await;
        browser.until("document.querySelectorAll('[data-tick]:checked').length === 0").await;
        browser.until("document.getElementById('ticked').hidden").await;
        for id in &ids {
            browser.click(&tick(id)).await;
        }
        browser.until("document.getElementById('tick-all').checked").await;
        browser.is_accessible().await;
        browser.picture("ticked").await;
        browser.click("#ticked a").await;
        browser.until("location.pathname === '/compare'").await;
        is_drawn(browser).await;

        let answer = server.get(&format!("/v1/compare?jobs={}", ids.join(","))).await.json();
        let table = "[aria-labelledby=parameters]";
        let said = browser.text(table).await;
        for row in answer["parameters"].as_array().unwrap() {
            assert!(said.contains(row["parameter"].as_str().unwrap()), "{said}");
            for value in row["values"].as_array().unwrap() {
                let Some(apart) = value["deviation"].as_f64() else { continue };
                assert!(said.contains(&format!("{apart:+.1}")), "{apart}: {said}");
            }
        }
        browser.says("main .note", "Jobs 1 and 3 were fitted to samples of the same recording").await;
        // the two on one recording share a plot, the other has its own
        let plots = "document.querySelectorAll('#compared .plot')";
        assert_eq!(browser.until(&format!("{plots}.length")).await, 2);
        let of = |plot: usize| format!("JSON.stringify([...new Set({plots}[{plot}].data.map(series => series.name))].sort())");
        assert_eq!(browser.until(&of(0)).await, r#"["input","measured","model 1","model 3","residual 1","residual 3"]"#);
        assert_eq!(browser.until(&of(1)).await, r#"["input 2","measured 2","model 2","residual 2"]"#);
        assert_eq!(browser.count("svg.plane path").await, 3 * modes_of(&answer));
        browser.says("#conditions", "Weighted means").await;
        looks_well(browser, "page").await;

        browser.choose("select[name=by]", "mean(alpha)").await;
        browser.click("form button").await;
        browser.says("#conditions", "Over the mean of alpha").await;
        is_drawn(browser).await;
        // by its number on this page
        browser.says("main", "job 3 is newer and was fitted to the same samples").await;
        assert!(browser.count(".tiles.wide svg").await > 3);
        looks_well(browser, "over-a-mean").await;
        browser.choose("select[name=by]", "").await;
        browser.choose("select[name=group]", "flaps").await;
        browser.click("form button").await;
        browser.says("[aria-labelledby=conditions]", "flaps=down").await;

        browser.click("[aria-label='leave out job 3']").await;
        browser.until(&format!("location.search === '?jobs={}%2C{}&group=flaps'", ids[0], ids[1])).await;
        is_drawn(browser).await;
        assert_eq!(browser.count("main .note").await, 0);
        // different recordings begin together
        assert_eq!(browser.until(&format!("{plots}.length")).await, 1);
        assert_eq!(browser.until(&format!("{plots}[0].data.every(series => series.x[0] === 0)")).await, true);
    })
    .await;
}

/// Eigenvalues that the plane has of one job: one of each pair.
fn modes_of(comparison: &serde_json::Value) -> u64 {
    comparison["jobs"][0]["modes"].as_array().unwrap().len() as u64
}

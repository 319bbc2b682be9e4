//! The pages as people use them, in a real browser: `tests/browser cargo test --test service pages::browser::`.

use crate::common::browser::{Browser, browse};
use crate::common::jobs::{endless_job, job};
use crate::common::process::{Process, own_address};
use crate::common::recordings::{elevator, elevator_of};
use crate::common::server::{Server, client, send};
use crate::common::swinging::swinging;
use fantoccini::key::Key;
use reqwest::StatusCode;
use serde_json::{Value, json};
use tempfile::TempDir;
use tokio_util::sync::CancellationToken;
use trimtab::http::Config;

/// A server without work to do, whose jobs wait until a test lets them go on.
pub(super) async fn idle() -> Server {
    Server::start_with(Config::default(), 0).await
}

/// Lets the jobs of a server go on, until what is returned is dropped.
pub(super) fn work(server: &Server) -> impl Drop + use<> {
    let shutdown = CancellationToken::new();
    let store = server.store.clone();
    tokio::spawn(trimtab::work::run(store, 1, shutdown.clone()));
    shutdown.drop_guard()
}

/// A job under way on a long maneuver, of so many iterations; its id.
async fn submit_long(server: &Server, iterations: u32) -> String {
    let mut spec = endless_job(&server.upload(&elevator_of(2000.0, 3)).await);
    spec["options"]["max_iterations"] = json!(iterations);
    server.submit(&spec).await
}

/// A job that is over; its id.
pub(super) async fn finished(server: &Server, name: &str, tags: &[&str], csv: &str) -> String {
    let mut spec = job(&server.upload(csv).await);
    (spec["name"], spec["tags"]) = (json!(name), json!(tags));
    let id = server.submit(&spec).await;
    assert_eq!(server.wait(&id).await["status"], "succeeded");
    id
}

/// The flights of an elevator with play, as a job of that kind uses them.
pub(super) async fn flights(server: &Server) -> Value {
    let mut uses = Vec::new();
    for (csv, role) in [
        (
            include_str!("../../../data/effects/elevator-backlash-fit.csv"),
            "estimation",
        ),
        (
            include_str!("../../../data/effects/elevator-backlash-check.csv"),
            "validation",
        ),
        (
            include_str!("../../../data/effects/elevator-backlash-final.csv"),
            "final",
        ),
    ] {
        uses.push(json!({"id": server.upload(csv).await, "label": role, "role": role}));
    }
    Value::Array(uses)
}

pub(super) async fn go(browser: &Browser, server: &Server, path: &str) {
    browser.go(&format!("{}{path}", server.url)).await;
}

/// Waits until a page has drawn all that it has, and nothing of it is cut off.
pub(super) async fn is_drawn(browser: &Browser) {
    let drawn = "document.readyState === 'complete' && !document.querySelector('[data-loading]') \
        && [...document.querySelectorAll('.plot')].every(plot => plot.querySelector('.main-svg .trace') \
            && plot.scrollWidth <= plot.clientWidth + 2 && plot.scrollHeight <= plot.clientHeight + 2)";
    browser.until(drawn).await;
}

/// Waits until a job is over, and its page, which is open, has turned into its result.
pub(super) async fn over(browser: &Browser, server: &Server, id: &str) {
    server.wait(id).await;
    browser.find("#job[data-over=true]").await;
    is_drawn(browser).await;
}

/// What the row of a job says in the list.
fn row(name: &str) -> String {
    format!(
        "[...document.querySelectorAll('#jobs tbody tr')].find(row => row.textContent.includes({name:?}))?.textContent"
    )
}

#[tokio::test]
async fn the_first_visit_leads_from_flights_to_try_to_a_job() {
    browse("first visit", async |browser| {
        let server = Server::start().await;
        go(browser, &server, "/").await;
        browser
            .says("main", "Nothing has been estimated here yet")
            .await;
        browser.picture("empty").await;
        browser.click("#examples").await;
        browser.until("location.pathname === '/new'").await;
        let address = browser.address().await;
        let given: Vec<(String, String)> = address.query_pairs().into_owned().collect();
        let of = |name: &str| given.iter().find(|(key, _)| key == name).unwrap().1.clone();
        assert_eq!(of("model"), "short-period");
        let stored = server.get("/v1/maneuvers").await.json();
        let stored = stored["maneuvers"].as_array().unwrap();
        assert_eq!(stored.len(), 3);
        for role in ["estimation", "validation", "final"] {
            assert!(stored.iter().any(|it| it["id"] == of(role)), "{role}");
        }

        // all is chosen, and what it comes to can be asked before it is submitted
        browser
            .until("document.querySelectorAll('#maneuvers tbody tr').length === 3")
            .await;
        browser.picture("new").await;
        browser.click("#check").await;
        browser.says("#said", "It can run: 626 samples").await;
        browser.click("#form button.main").await;
        browser.find("#job").await;
        let id = browser.text("#job .facts code").await;
        let spec = server.get(&format!("/v1/jobs/{id}/spec")).await.json();
        assert_eq!(spec["maneuvers"].as_array().unwrap().len(), 3);
        over(browser, &server, &id).await;
        browser.says(".verdict", "backlash").await;
        browser.click(".actions a.main").await;
        browser.until("location.pathname.endsWith('/report')").await;
        let report = browser.text("main").await;
        for part in ["My first job", "Mde", &id] {
            assert!(report.contains(part), "{part}: {report}");
        }
        browser.picture("report").await;
    })
    .await;
}

#[tokio::test]
async fn a_new_job_says_what_is_wrong_with_it_and_where() {
    browse("new job", async |browser| {
        let server = idle().await;
        let maneuver = server.upload(&elevator()).await;
        go(browser, &server, &format!("/new?estimation={maneuver}")).await;
        browser.find("#maneuvers tbody tr").await;
        browser.click("#form button.main").await;
        browser.says("#faults", "Choose a model").await;
        go(
            browser,
            &server,
            &format!("/new?model=short-period&estimation={maneuver}"),
        )
        .await;
        browser.find("#maneuvers tbody tr").await;
        let at = |text: &str| format!("#maneuvers [aria-label^='{text} second']");
        let begin = "document.querySelector('#maneuvers .fault')";
        browser.fill(&at("first"), "15").await;
        browser.click("#check").await;
        browser.until(&format!("{begin}?.textContent.includes('both seconds')")).await;
        browser.fill(&at("last"), "5").await;
        browser.expect_error("422");
        browser.click("#check").await;
        browser.until(&format!("{begin}?.textContent.includes('seconds 15 to 5')")).await;
        // the field at fault has the focus, and says what is wrong with it
        let told = "document.getElementById(document.activeElement.getAttribute('aria-describedby'))?.textContent";
        assert_eq!(browser.until(told).await, browser.text("#maneuvers .fault").await);
        browser.is_accessible().await;
        browser.picture("seconds").await;
        browser.correct(&at("first"), "2").await;
        browser.correct(&at("last"), "7").await;
        browser.click("#check").await;
        browser.says("#said", "It can run").await;
        assert_eq!(browser.count(".fault").await, 0);
        let spec = browser.run("return JSON.parse(document.getElementById('json').value)").await;
        assert_eq!(spec["maneuvers"][0]["seconds"], json!([2, 7]));
        browser.click("#maneuvers [aria-label^='another part']").await;
        browser.until("document.querySelectorAll('#maneuvers tbody tr').length === 2").await;
        let spec = browser.run("return JSON.parse(document.getElementById('json').value)").await;
        assert_ne!(spec["maneuvers"][0]["label"], spec["maneuvers"][1]["label"]);
        browser.choose("#maneuvers tr:nth-child(2) select", "").await;
        browser.click("details:has(#parameters) summary").await;
        // a lower bound above the start value
        browser
            .fill("#parameters [aria-label$='of Mde'][aria-label*='low']", "5")
            .await;
        browser.expect_error("422");
        browser.click("#check").await;
        browser.says("#faults", "Mde").await;
        let told = browser.text("#faults").await;
        assert!(!told.contains("/parameters"), "{told}");
        browser.says("#parameters tr:has(.fault)", "Mde").await;
        browser.until("document.activeElement.getAttribute('aria-label')?.endsWith('of Mde')").await;
        browser.picture("bound").await;
        // a job that cannot be read is not sent as it was before
        browser.click("details:has(#json) summary").await;
        browser.fill("#json", "oops").await;
        browser.click("#form button.main").await;
        browser.says("#faults", "nothing was sent").await;
        assert_eq!(server.get("/v1/jobs").await.json()["jobs"], json!([]));
        browser.is_accessible().await;
        browser.picture("fault").await;
    })
    .await;
}

#[tokio::test]
async fn a_recording_is_corrected_before_it_is_stored() {
    browse("upload", async |browser| {
        let server = idle().await;
        let file = server.directory.path().join("first flight.csv");
        let csv = elevator();
        // without its time no recording is one
        assert!(csv.starts_with("t[s]"));
        std::fs::write(&file, csv.replacen("t[s]", "t[sx]", 1)).unwrap();
        go(browser, &server, "/maneuvers").await;
        browser.fill("#choose", file.to_str().unwrap()).await;
        let row = "document.querySelector('section.file tbody tr:nth-child(1)')";
        browser
            .until(&format!("{row}?.textContent.includes('sx')"))
            .await;
        browser.expect_error("422");
        browser.click("section.file [data-part=send]").await;
        browser.says("section.file", "It was not stored").await;
        browser.picture("fault").await;
        browser.is_accessible().await;
        assert_eq!(
            server.get("/v1/maneuvers").await.json()["maneuvers"],
            json!([])
        );
        let unit = "section.file tbody tr:nth-child(1) input[list=units]";
        browser.correct(unit, "s").await;
        browser.click("section.file [data-part=send]").await;
        browser.says("section.file", "Stored as").await;
        browser.picture("stored").await;
        browser.click("#maneuvers tbody a").await;
        browser.find("#maneuver .plot .main-svg").await;
        is_drawn(browser).await;
        for dark in [false, true] {
            browser.dark(dark).await;
            browser.is_accessible().await;
            browser.picture("maneuver").await;
        }
        browser.resize(360, 800).await;
        is_drawn(browser).await;
        browser.fits().await;
    })
    .await;
}

#[tokio::test]
async fn the_list_follows_jobs_and_is_filtered() {
    browse("list of jobs", async |browser| {
        let server = idle().await;
        let maneuver = server.upload(&elevator()).await;
        let mut first = job(&maneuver);
        first["name"] = json!("of today");
        server.submit(&first).await;
        go(browser, &server, "/").await;
        let said = browser.until(&row("of today")).await;
        assert!(said.as_str().unwrap().contains("queued"), "{said}");

        // from here on nothing is loaded anew
        browser.run("window.stayed = true").await;
        let mut second = job(&maneuver);
        (second["name"], second["tags"]) = (json!("come since"), json!(["late"]));
        server.submit(&second).await;
        browser.until(&row("come since")).await;
        let _work = work(&server);
        for name in ["of today", "come since"] {
            let over = format!("{}?.includes('succeeded')", row(name));
            browser.until(&over).await;
        }
        assert_eq!(browser.run("return window.stayed").await, true);
        browser.picture("two").await;

        browser.fill("input[name=tag]", "late").await;
        browser.choose("select[name=status]", "succeeded").await;
        browser.click("form button").await;
        browser.until("location.search.includes('tag=late')").await;
        browser.until(&row("come since")).await;
        assert_eq!(browser.count("#jobs tbody tr").await, 1);
        browser.choose("select[name=kind]", "diagnose").await;
        browser.click("form button").await;
        browser.says("#jobs", "No job matches").await;
        browser.click("form a").await;
        browser.until(&row("of today")).await;
        assert_eq!(browser.count("#jobs tbody tr").await, 2);
    })
    .await;
}

#[tokio::test]
async fn lists_are_searched_and_models_of_one_name_told_apart() {
    browse("names", async |browser| {
        let server = Server::start().await;
        let mut spec = job(&server.upload(&elevator()).await);
        spec["maneuvers"][0]["label"] = json!("Flight 12, doublet");
        server.wait(&server.submit(&spec).await).await;
        spec["maneuvers"][0]["label"] = json!("Flight 13");
        server.wait(&server.submit(&spec).await).await;
        spec["name"] = json!("the good one");
        server.wait(&server.submit(&spec).await).await;
        go(browser, &server, "/").await;
        let first = browser
            .until(&row("short-period: Flight 12, doublet"))
            .await;
        assert!(first.as_str().unwrap().contains("0.99"), "{first}");
        browser.is_accessible().await;
        browser.picture("jobs").await;
        browser.fill("input[name=q]", "flight 13").await;
        browser.press(Key::Enter).await;
        browser
            .until("document.querySelectorAll('#jobs tbody tr').length === 2")
            .await;
        browser.until(&row("the good one")).await;
        browser.picture("found").await;

        let mut document = server.get("/v1/models/short-period").await.json();
        document["name"] = json!("mine");
        let mut ids = Vec::new();
        for _ in 0..2 {
            let stored = server.post_json("/v1/models", &document).await.json();
            ids.push(stored["id"].as_str().unwrap().to_string());
        }
        go(browser, &server, "/models?q=mine").await;
        assert_eq!(browser.count("table.models tbody tr").await, 2);
        browser.is_accessible().await;
        browser.picture("models").await;
        browser.click(&format!("[data-delete={:?}]", ids[0])).await;
        browser.accept().await;
        browser.says("#live", "mine is deleted").await;
        assert_eq!(browser.count("table.models tbody tr").await, 1);
        assert_eq!(
            server.get(&format!("/v1/models/{}", ids[0])).await.status,
            404
        );
        assert_eq!(
            server.get(&format!("/v1/models/{}", ids[1])).await.status,
            200
        );
        go(browser, &server, "/new").await;
        let tail = &ids[1][ids[1].len() - 8..];
        browser.says("#model", &format!(", {tail})")).await;
        go(browser, &server, "/maneuvers?q=nothing").await;
        browser.says("#maneuvers", "No maneuver matches").await;
        browser.picture("maneuvers").await;
    })
    .await;
}

#[tokio::test]
async fn a_finished_job_is_told_in_tables_and_plots_that_zoom_together() {
    browse("finished job", async |browser| {
        let server = Server::start().await;
        // more samples than a plot of the whole shows
        let id = finished(&server, "long", &[], &elevator_of(200.0, 7)).await;
        go(browser, &server, &format!("/jobs/{id}")).await;
        is_drawn(browser).await;
        browser.picture("whole").await;
        let table = server.get(&format!("/v1/jobs/{id}/parameters")).await;
        let table = table.json();
        let said = browser.text("[aria-labelledby=parameters]").await;
        for parameter in table["parameters"].as_array().unwrap() {
            assert!(said.contains(parameter["name"].as_str().unwrap()), "{said}");
        }

        let plot = "document.querySelector('#histories-plots .plot')";
        let range = format!("{plot}._fullLayout.xaxis.range");
        let shown = async || {
            let range = browser.until(&range).await;
            range[1].as_f64().unwrap() - range[0].as_f64().unwrap()
        };
        let axes = format!("new Set({plot}.data.map(series => series.xaxis)).size");
        assert_eq!(browser.until(&axes).await, 1, "all rows have one time");
        let rows = format!("{plot}._fullLayout._subplots.cartesian.length");
        assert_eq!(
            browser.until(&rows).await,
            5,
            "two outputs, each with its residual, and an input"
        );
        let whole = shown().await;
        assert!(whole > 199.0, "{whole}");
        browser
            .drag("#histories-plots .plot .nsewdrag", 0.4, 0.5)
            .await;
        // a stretch of it comes with all its samples
        let all = format!(
            "(time => time.length < 1000 && time.length > 300 && time[1] - time[0] < 0.05)({plot}.data[0].x)"
        );
        browser.until(&all).await;
        let part = shown().await;
        assert!((part / whole - 0.1).abs() < 0.02, "{part} of {whole}");
        browser.picture("zoomed").await;
        browser
            .double_click("#histories-plots .plot .nsewdrag")
            .await;
        let again = format!("{range}[1] - {range}[0] > 199 && {plot}.data[0].x.at(-1) > 199");
        browser.until(&again).await;
    })
    .await;
}

#[tokio::test]
async fn a_job_is_seen_to_run_and_stopped_by_its_button() {
    browse("running job", async |browser| {
        let server = idle().await;
        let id = submit_long(&server, 1000).await;
        go(browser, &server, &format!("/jobs/{id}")).await;
        browser.says("#state", "waits for a worker").await;
        let _work = work(&server);
        let points = "document.querySelector('#job[data-over=false] #cost.js-plotly-plot')?.data[0].x.length";
        let first = browser.until(&format!("({points} > 1 && {points})")).await;
        browser.picture("under way").await;
        browser.until(&format!("{points} > {first}")).await;
        browser.says("#state", "iteration").await;
        browser.says(".state", "running").await;
        browser.click("[data-act=cancel]").await;
        over(browser, &server, &id).await;
        browser.says(".state", "cancelled").await;
        browser.says(".state + *", "stopped on request").await;
        // what it had by then is its result
        assert_eq!(browser.count("[aria-labelledby=parameters] table").await, 1);
        browser.picture("result").await;
    })
    .await;
}

#[tokio::test]
async fn a_page_outlives_the_server_and_is_completed_by_the_next() {
    browse("lost connection", async |browser| {
        let directory = TempDir::new().unwrap();
        let database = crate::common::server::database(directory.path());
        let database = database.to_str().unwrap();
        let server = Process::serve(database, &own_address(), 0);
        let url = server.url.clone();
        let csv = client().post(format!("{url}/v1/maneuvers"));
        let csv = csv.header("content-type", "text/csv").body(elevator());
        let maneuver = send(csv).await.json()["id"].as_str().unwrap().to_string();
        let submitted = send(
            client()
                .post(format!("{url}/v1/jobs"))
                .json(&job(&maneuver)),
        )
        .await;
        assert_eq!(submitted.status, StatusCode::ACCEPTED);
        let id = submitted.json()["id"].as_str().unwrap().to_string();
        browser.go(&format!("{url}/jobs/{id}")).await;
        browser.says("#state", "waits for a worker").await;

        browser.expect_error("ERR_");
        server.kill();
        browser.says("#connection", "The connection is lost").await;
        let listen = url.strip_prefix("http://").unwrap();
        let again = Process::serve(database, listen, 1);
        assert_eq!(again.url, url);
        browser.find("#job[data-over=true]").await;
        is_drawn(browser).await;
        browser.says(".state", "succeeded").await;
    })
    .await;
}

#[tokio::test]
async fn a_diagnosis_is_told_as_a_story() {
    browse("diagnosis", async |browser| {
        let server = Server::start().await;
        let uses = flights(&server).await;
        let spec = json!({"kind": "diagnose", "model": "short-period", "maneuvers": uses});
        let id = server.submit(&spec).await;
        go(browser, &server, &format!("/jobs/{id}")).await;
        over(browser, &server, &id).await;
        let verdict = browser.text(".verdict").await;
        assert!(verdict.to_lowercase().contains("backlash"), "{verdict}");
        let story = browser.text("[aria-labelledby=diagnosis]").await;
        for part in [
            "Errors before and after",
            "de_backlash",
            "final test",
            "refused",
        ] {
            assert!(story.contains(part), "{part}: {story}");
        }
        let declared = "document.querySelector('#histories-plots .plot').data.some(series => series.name === 'declared model')";
        browser.until(declared).await;
        for dark in [false, true] {
            browser.dark(dark).await;
            is_drawn(browser).await;
            browser.is_accessible().await;
            browser.picture("story").await;
        }
        browser.resize(360, 800).await;
        is_drawn(browser).await;
        browser.fits().await;
        browser.picture("narrow").await;
    })
    .await;
}

#[tokio::test]
async fn what_no_catalogue_has_is_drawn() {
    browse("unmodelled", async |browser| {
        let server = Server::start().await;
        let [fit, check] = swinging();
        let uses = json!([
            {"id": server.upload(&fit).await, "label": "fit", "role": "estimation"},
            {"id": server.upload(&check).await, "label": "check", "role": "validation"},
        ]);
        let spec = json!({"kind": "diagnose", "model": "short-period", "maneuvers": uses});
        let id = server.submit(&spec).await;
        go(browser, &server, &format!("/jobs/{id}")).await;
        over(browser, &server, &id).await;
        let left = browser.text("[aria-labelledby=unmodelled]").await;
        for part in [
            "What is left, as a force in the equation of q",
            "force in q [deg/s^2]",
            "check, not fitted",
            "share in flights not fitted",
            "spectrum",
        ] {
            assert!(left.contains(part), "{part}: {left}");
        }
        for dark in [false, true] {
            browser.dark(dark).await;
            is_drawn(browser).await;
            browser.is_accessible().await;
            browser.picture("force").await;
        }
        browser.resize(360, 800).await;
        is_drawn(browser).await;
        browser.fits().await;
        browser.picture("narrow").await;
        // the printed report has it too
        go(browser, &server, &format!("/jobs/{id}/report")).await;
        browser.says("main", "What is left, as a force in").await;
    })
    .await;
}

#[tokio::test]
async fn everything_is_reached_by_keyboard() {
    browse("keyboard", async |browser| {
        let server = Server::start().await;
        finished(&server, "by hand", &[], &elevator()).await;
        go(browser, &server, "/").await;
        let way = browser.tab_to("a New job").await;
        assert_eq!(
            way,
            [
                "a Skip to the content",
                "a Trimtab, jobs",
                "a Jobs",
                "a Maneuvers",
                "a Models"
            ]
        );
        // out of the ways, into what can be done, and to the table
        browser.tab_to("a API").await;
        browser.tab_to("a New job").await;
        browser.tab_to("select Status").await;
        let way = browser.tab_to("a by hand").await;
        for part in ["select Kind", "input Tag", "button Search", "div Jobs"] {
            assert!(way.iter().any(|at| at == part), "{part}: {way:?}");
        }
        browser.press(Key::Enter).await;
        browser.find("#job[data-over=true]").await;
        is_drawn(browser).await;

        // past the ways at once, and to what can be done
        assert_eq!(browser.tab_to("a Report").await[0], "a Skip to the content");
        browser.run("document.activeElement.blur()").await;
        go(browser, &server, "/").await;
        browser.press(Key::Tab).await;
        assert_eq!(browser.focus().await, "a Skip to the content");
        browser.press(Key::Enter).await;
        browser
            .until("document.activeElement.id === 'content'")
            .await;
        browser.press(Key::Tab).await;
        assert_eq!(browser.focus().await, "a New job");
        browser.tab_to("a by hand").await;
        browser.press(Key::Enter).await;
        let first = browser
            .until("document.querySelector('#job')?.dataset.job")
            .await;
        browser.tab_to("button Run again").await;
        browser.press(Key::Enter).await;
        let other = "document.querySelector('#job')?.dataset.job";
        browser
            .until(&format!("{other} && {other} !== {first}"))
            .await;
        browser.find("#job[data-over=true]").await;
    })
    .await;
}

#[tokio::test]
async fn pages_are_accessible_in_light_and_dark_and_fit_a_narrow_screen() {
    browse("every page", async |browser| {
        let server = idle().await;
        let mut pages = vec!["/".to_string()];
        let look = async |pages: &[String]| {
            for page in pages {
                go(browser, &server, page).await;
                for dark in [false, true] {
                    browser.dark(dark).await;
                    is_settled(browser).await;
                    browser.is_accessible().await;
                    browser.picture(if dark { "dark" } else { "light" }).await;
                }
                browser.resize(360, 800).await;
                is_settled(browser).await;
                browser.fits().await;
                browser.picture("narrow").await;
                browser.resize(1300, 900).await;
                browser.dark(false).await;
            }
        };
        look(&pages).await;

        // one that is over, one that failed to converge, one that waits
        let working = work(&server);
        let name = "a-name-as-long-as-they-come-without-a-space-to-break-it-at-in-two";
        let over = finished(&server, name, &["tagged"], &elevator()).await;
        let stopped = submit_long(&server, 2).await;
        server.wait(&stopped).await;
        drop(working);
        let waiting = server.submit(&job(&server.upload(&elevator()).await)).await;
        pages.extend([&over, &stopped, &waiting].map(|id| format!("/jobs/{id}")));
        pages.push(format!("/jobs/{over}/dynamics"));
        pages.extend([format!("/jobs/{over}/report"), format!("/new?like={over}")]);
        pages.extend(
            [
                "/maneuvers",
                "/models",
                "/models/short-period",
                "/guide",
                "/guide/method",
                "/guide/findings",
            ]
            .map(String::from),
        );
        look(&pages).await;
    })
    .await;
}

/// As [`is_drawn`], of pages where something may be yet to come.
async fn is_settled(browser: &Browser) {
    let waits = browser.count("#job[data-over=false]").await > 0;
    if waits {
        browser.says("#state", "waits").await;
    } else {
        is_drawn(browser).await;
    }
}

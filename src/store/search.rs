//! Finding by words: what has a name is kept with its words in lower case, and a search finds what has each of its words
//! somewhere in them. Lower case is made here and not by the databases, which differ in it.

use sqlx::any::AnyRow;
use sqlx::{AnyConnection, Row};

use super::StoreError;
use super::about::About;
use super::results::fit_of;
use super::writing::Writing;
use crate::flight::Flown;

/// A search: words, of which each must be there, as part of a word or whole.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Search(Vec<String>);

impl Search {
    pub fn of(text: &str) -> Self {
        let words = text.split_whitespace();
        Self(words.map(str::to_lowercase).collect())
    }

    /// Whether a text has all words.
    pub fn finds(&self, text: &str) -> bool {
        let text = text.to_lowercase();
        self.0.iter().all(|word| text.contains(word.as_str()))
    }

    /// A condition on a column for each word, with its value; `?` is the place of the value.
    pub(super) fn conditions(&self, column: &str) -> Vec<(String, String)> {
        let condition = format!(r"{column} LIKE ? ESCAPE '\'");
        let pattern = |word: &String| {
            let escaped = word.chars().flat_map(|c| {
                let sign = matches!(c, '%' | '_' | '\\').then_some('\\');
                sign.into_iter().chain([c])
            });
            format!("%{}%", escaped.collect::<String>())
        };
        let words = self.0.iter();
        words
            .map(|word| (condition.clone(), pattern(word)))
            .collect()
    }
}

/// The words of a job: how it is called, its tags, its model and maneuvers. Ids are no words: they have every number in
/// them.
pub(super) fn words_of_job(name: &str, tags: &[String], about: &About) -> String {
    let labels = about
        .maneuvers
        .iter()
        .map(|maneuver| maneuver.label.as_str());
    let tags = tags.iter().map(String::as_str);
    let one = [name, about.model.name.as_str()];
    joined(one.into_iter().chain(tags).chain(labels))
}

/// The words of a maneuver: its name, and what was flown in words.
pub(super) fn words_of_maneuver(name: &str, flown: &Flown) -> String {
    let said = [
        &flown.aircraft,
        &flown.registration,
        &flown.flight,
        &flown.test_point,
        &flown.date,
        &flown.configuration,
        &flown.notes,
    ];
    let said = said.into_iter().flatten().map(String::as_str);
    let tags = flown.tags.iter().map(String::as_str);
    joined([name].into_iter().chain(said).chain(tags))
}

/// The words of a model: name and title.
pub(super) fn words_of_model(name: &str, title: &str) -> String {
    joined([name, title].into_iter())
}

fn joined<'a>(words: impl Iterator<Item = &'a str>) -> String {
    // a search has no line breaks: no word reaches from one to the next
    words.collect::<Vec<_>>().join("\n").to_lowercase()
}

/// Gives the rows of earlier versions their words, and what else is kept for lists.
pub(super) async fn fill_in(writing: &mut Writing) -> Result<(), StoreError> {
    for id in missing(
        writing.connection(),
        "SELECT id FROM jobs WHERE words IS NULL",
    )
    .await?
    {
        fill_in_job(writing.connection(), &id.try_get::<String, _>("id")?).await?;
    }
    let maneuvers = "SELECT project, id, name, flown FROM maneuvers WHERE words IS NULL";
    for row in missing(writing.connection(), maneuvers).await? {
        let id: &str = row.try_get("id")?;
        let flown = serde_json::from_str(row.try_get("flown")?).unwrap_or_default();
        sqlx::query("UPDATE maneuvers SET words = $3 WHERE project = $1 AND id = $2")
            .bind(row.try_get::<&str, _>("project")?)
            .bind(id)
            .bind(words_of_maneuver(row.try_get("name")?, &flown))
            .execute(writing.connection())
            .await?;
    }
    let models = "SELECT id, name, title FROM models WHERE words IS NULL";
    for row in missing(writing.connection(), models).await? {
        let id: &str = row.try_get("id")?;
        sqlx::query("UPDATE models SET words = $2 WHERE id = $1")
            .bind(id)
            .bind(words_of_model(row.try_get("name")?, row.try_get("title")?))
            .execute(writing.connection())
            .await?;
    }
    Ok(())
}

async fn missing(
    connection: &mut AnyConnection,
    select: &'static str,
) -> Result<Vec<AnyRow>, StoreError> {
    Ok(sqlx::query(select).fetch_all(connection).await?)
}

async fn fill_in_job(connection: &mut AnyConnection, id: &str) -> Result<(), StoreError> {
    let job = sqlx::query("SELECT project, name, tags, spec, model FROM jobs WHERE id = $1")
        .bind(id)
        .fetch_one(&mut *connection)
        .await?;
    let (spec, model) = (job.try_get("spec")?, job.try_get("model")?);
    let about = About::of(&mut *connection, job.try_get("project")?, spec, model).await?;
    let tags: Vec<String> = serde_json::from_str(job.try_get("tags")?).unwrap_or_default();
    let result = sqlx::query("SELECT body FROM results WHERE job = $1 AND part = 'estimate'")
        .bind(id)
        .fetch_optional(&mut *connection)
        .await?;
    let fit = match result {
        Some(row) => fit_of(row.try_get("body")?),
        None => None,
    };
    sqlx::query("UPDATE jobs SET about = $2, words = $3, fit = $4 WHERE id = $1")
        .bind(id)
        .bind(serde_json::to_string(&about).unwrap_or_default())
        .bind(words_of_job(job.try_get("name")?, &tags, &about))
        .bind(fit)
        .execute(connection)
        .await?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_word_must_be_there_and_signs_are_signs() {
        let search = Search::of("  Flight 12\tÄ");
        assert!(search.finds("ätna, flight no. 12"));
        assert!(!search.finds("flight 12"));
        assert!(Search::of("").finds(""));
        let conditions = Search::of(r"5%_\").conditions("words");
        assert_eq!(
            conditions,
            [(
                r"words LIKE ? ESCAPE '\'".to_string(),
                r"%5\%\_\\%".to_string()
            )]
        );
    }
}

//! Mapping documents that a project keeps, by name. One is never changed: what was read by it would not be known any more.

use sqlx::Row;
use sqlx::any::AnyRow;

use super::audit::Deed;
use super::page::readable;
use super::{Project, StoreError};

#[derive(Clone, PartialEq, Eq, Debug)]
pub struct MappingRecord {
    pub name: String,
    pub created: String,
    /// JSON.
    pub document: String,
}

fn read_mapping(row: &AnyRow) -> Result<MappingRecord, StoreError> {
    Ok(MappingRecord {
        name: row.try_get("name")?,
        created: row.try_get("created")?,
        document: row.try_get("document")?,
    })
}

impl Project {
    /// Keeps a mapping that was checked; `false`: there is another one of this name.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn add_mapping(&self, name: &str, document: &str) -> Result<bool, StoreError> {
        let sql = "INSERT INTO mappings (project, name, created, document) VALUES ($1, $2, $3, $4) \
                   ON CONFLICT (project, name) DO NOTHING";
        let inserted = sqlx::query(sql)
            .bind(&*self.name)
            .bind(name)
            .bind(self.store.clock.now_text())
            .bind(document)
            .execute(&self.store.writer)
            .await?;
        if inserted.rows_affected() > 0 {
            return Ok(true);
        }
        let known = self.mapping(name).await?;
        Ok(known.is_some_and(|known| known.document == document))
    }

    /// # Errors
    /// The database does not answer.
    pub async fn mapping(&self, name: &str) -> Result<Option<MappingRecord>, StoreError> {
        let sql = "SELECT name, created, document FROM mappings WHERE project = $1 AND name = $2";
        let row = sqlx::query(sql)
            .bind(&*self.name)
            .bind(name)
            .fetch_optional(&self.store.readers)
            .await?;
        row.as_ref().map(read_mapping).transpose()
    }

    /// All of them, by name.
    ///
    /// # Errors
    /// The database does not answer.
    pub async fn mappings(&self) -> Result<Vec<MappingRecord>, StoreError> {
        let sql = "SELECT name, created, document FROM mappings WHERE project = $1 ORDER BY name";
        let rows = sqlx::query(sql)
            .bind(&*self.name)
            .fetch_all(&self.store.readers)
            .await?;
        Ok(readable(&rows, read_mapping))
    }

    /// Whether there was one.
    ///
    /// # Errors
    /// The database cannot be written.
    pub async fn delete_mapping(&self, name: &str) -> Result<bool, StoreError> {
        let sql = "DELETE FROM mappings WHERE project = $1 AND name = $2";
        let mut writing = self.store.begin().await?;
        let deleted = sqlx::query(sql)
            .bind(&*self.name)
            .bind(name)
            .execute(writing.connection())
            .await?;
        if deleted.rows_affected() == 0 {
            return Ok(false);
        }
        self.note(&mut writing, Deed::MappingDeleted, name).await?;
        writing.commit().await?;
        Ok(true)
    }
}

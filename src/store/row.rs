//! Reading a row.

use sqlx::Row;
use sqlx::any::AnyRow;
use uuid::Uuid;

use super::error::StoreError;

pub(super) fn read_id(row: &AnyRow, column: &str) -> Result<Uuid, StoreError> {
    let text: &str = row.try_get(column)?;
    Uuid::parse_str(text).map_err(|error| StoreError::corrupt(format!("id '{text}'"), error))
}

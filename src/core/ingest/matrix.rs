//! A matrix of numbers as a file holds it, and the rows and columns taken out of it.

use super::stored::Stored;

/// Numbers by row and column; they are made into doubles when they are taken out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Matrix<'a> {
    pub(super) rows: usize,
    pub(super) columns: usize,
    values: Values<'a>,
}

#[derive(Clone, Copy, Debug)]
enum Values<'a> {
    /// Row by row.
    Rows(&'a [f64]),
    /// Column by column.
    Stored { bytes: &'a [u8], number: Stored },
}

impl<'a> Matrix<'a> {
    /// Of values row by row, in rows of `columns`.
    pub(super) fn of_rows(values: &'a [f64], columns: usize) -> Self {
        Self {
            rows: values.len() / columns.max(1),
            columns,
            values: Values::Rows(values),
        }
    }

    /// Of numbers column by column. `None` where there are not `rows * columns` of them.
    pub(super) fn of_bytes(
        [rows, columns]: [usize; 2],
        bytes: &'a [u8],
        number: Stored,
    ) -> Option<Self> {
        let length = rows.checked_mul(columns)?.checked_mul(number.width)?;
        (length == bytes.len()).then_some(Self {
            rows,
            columns,
            values: Values::Stored { bytes, number },
        })
    }

    /// Whether it has one row or one column.
    pub(super) fn is_vector(&self) -> bool {
        self.rows == 1 || self.columns == 1
    }

    /// The value at a row and a column, from 0; NaN where there is none.
    fn at(&self, row: usize, column: usize) -> f64 {
        let value = match self.values {
            Values::Rows(values) => values.get(row * self.columns + column).copied(),
            Values::Stored { bytes, number } => {
                let from = (column * self.rows + row) * number.width;
                bytes.get(from..from + number.width).map(number.read)
            }
        };
        value.unwrap_or(f64::NAN)
    }

    /// The values of a column, from 0.
    pub(super) fn column(&self, column: usize) -> Vec<f64> {
        (0..self.rows).map(|row| self.at(row, column)).collect()
    }

    /// The values of a row, from 0.
    pub(super) fn row(&self, row: usize) -> Vec<f64> {
        (0..self.columns)
            .map(|column| self.at(row, column))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_columns_are_taken_out() {
        let by_rows = Matrix::of_rows(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 3);
        let byte = Stored {
            width: 1,
            read: |bytes| f64::from(bytes[0]),
        };
        let by_columns = Matrix::of_bytes([2, 3], &[1, 4, 2, 5, 3, 6], byte).unwrap();
        for matrix in [by_rows, by_columns] {
            assert_eq!((matrix.rows, matrix.columns), (2, 3));
            assert_eq!(matrix.column(2), [3.0, 6.0]);
            assert_eq!(matrix.row(1), [4.0, 5.0, 6.0]);
            assert!(!matrix.is_vector());
        }
        assert!(Matrix::of_bytes([2, 2], &[1], byte).is_none());
        assert!(Matrix::of_bytes([usize::MAX, 2], &[], byte).is_none());
        assert_eq!(Matrix::of_rows(&[], 0).rows, 0);
    }
}

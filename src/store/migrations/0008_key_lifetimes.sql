-- A key that replaces another lives as long as was asked for that one.

ALTER TABLE keys ADD COLUMN lifetime BIGINT; -- s; 0: for ever; NULL: of a key from before this was kept

-- Many machines on one database: whoever writes a second time what it was not told had arrived writes it once.

ALTER TABLE jobs ADD COLUMN written BIGINT NOT NULL DEFAULT 0; -- events of the worker of this attempt

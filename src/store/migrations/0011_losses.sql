-- Which losses of workers count against a job: see store/losses.rs.

ALTER TABLE jobs ADD COLUMN lost_alone BIGINT NOT NULL DEFAULT 0; -- workers lost that ran nothing else; `lost` counts the others
ALTER TABLE jobs ADD COLUMN alone BIGINT NOT NULL DEFAULT 0;      -- 1: the worker that has it runs nothing else
ALTER TABLE jobs ADD COLUMN counted BIGINT NOT NULL DEFAULT 0;    -- the attempt that counts as lost by the latest claim; below 0: it ran alone

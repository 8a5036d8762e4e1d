"""What a connection to a stranger's file may do: read and write plain tables, and little else."""

import sqlite3

LIMITS = {
    sqlite3.SQLITE_LIMIT_SQL_LENGTH: 100_000,
    sqlite3.SQLITE_LIMIT_COLUMN: 64,
    sqlite3.SQLITE_LIMIT_EXPR_DEPTH: 32,
    sqlite3.SQLITE_LIMIT_COMPOUND_SELECT: 8,
    sqlite3.SQLITE_LIMIT_VDBE_OP: 25_000,
    sqlite3.SQLITE_LIMIT_FUNCTION_ARG: 8,
    sqlite3.SQLITE_LIMIT_ATTACHED: 1,
    sqlite3.SQLITE_LIMIT_LIKE_PATTERN_LENGTH: 100,
    sqlite3.SQLITE_LIMIT_TRIGGER_DEPTH: 1,
    sqlite3.SQLITE_LIMIT_WORKER_THREADS: 0,
}
"""What SQLite takes, far above what tracks need: what a file makes it do ends soon."""


def guard(connection: sqlite3.Connection, most_bytes: int) -> None:
    """Put bounds to what a file can cause before anything of it is read.

    Its schema calls no function with effects, what its pages say of their cells is checked before
    it is followed, and nothing is larger than it may be.

    Args:
        connection: To the file.
        most_bytes: Largest text or blob.
    """
    connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, most_bytes)
    for limit, most in LIMITS.items():
        connection.setlimit(limit, most)
    connection.execute("PRAGMA trusted_schema = OFF")
    connection.execute("PRAGMA cell_size_check = ON")

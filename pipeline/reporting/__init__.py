"""What came of a run, written for programs (JSON) or for people (one page of HTML)."""

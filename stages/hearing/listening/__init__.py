"""Listening: from samples to beats, bars, onsets and envelopes."""

"""Figures, a module for each kind. A figure draws datasets or a schematic and computes nothing."""

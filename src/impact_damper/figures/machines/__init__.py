"""Figures of one machine and the damper designed for it; a page shows all, the chapter two."""

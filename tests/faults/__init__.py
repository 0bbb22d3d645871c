"""Trials of faults during a run, such as kills, damaged files and full disks: `make faults`."""

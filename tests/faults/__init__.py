"""Trials of faults during a run of the workflow, such as kills, damaged files and full disks.

`make faults` runs them. In each trial a copy of the project suffers a fault. Then the same command
is run again, and the results must be equal to the results of a run without a fault.
"""

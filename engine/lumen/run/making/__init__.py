"""The makers of Lumen's own parts: functions that take the services made so far (`lumen.features.core`)."""

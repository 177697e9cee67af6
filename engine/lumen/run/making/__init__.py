"""The makers of Lumen's own parts: functions that receive the services made so far (`lumen.features.core`)."""

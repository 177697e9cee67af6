"""Work for more than one process: tasks on all cores of this machine or on a cluster, by one kind of executor."""

"""Features of packages that are installed beside Lumen: each kind of row works, and a faulty one is a finding."""

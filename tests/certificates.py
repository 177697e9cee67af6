"""A certificate authority, and the certificate that it signs for a broker."""

from pathlib import Path

from tests.guarded import run_guarded
from tests.provided import program

KEY = ["-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes"]


def certify(folder: Path, name: str, days: int = 2) -> Path:
    """Write `ca.pem`, `server.pem` and `server.key` for a host (`IP:…` or `DNS:…`) into a folder; return the folder."""
    good = ["-days", str(days)]
    _openssl(folder, "req", "-x509", *KEY, *good, "-keyout", "ca.key", "-out", "ca.pem", "-subj", "/CN=Hall")
    _openssl(folder, "req", *KEY, "-keyout", "server.key", "-out", "server.csr", "-subj", "/CN=broker")
    (folder / "names").write_text(f"subjectAltName={name}\n")
    signing = ["-CA", "ca.pem", "-CAkey", "ca.key", "-CAcreateserial", *good, "-extfile", "names"]
    _openssl(folder, "x509", "-req", "-in", "server.csr", *signing, "-out", "server.pem")
    return folder


def _openssl(folder: Path, *arguments: str) -> None:
    run_guarded([program("openssl"), *arguments], cwd=folder, check=True, capture_output=True)

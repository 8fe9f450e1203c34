"""Decoding of picture files from strangers, in a helper process that can do nothing else.

Decoders of picture formats are large libraries in C. A file that is made to exploit an error in one of them costs an
error message here: the helper has limits on memory and time, no files, no network and no other processes. A file that
was decoded well before is known by its digest, and is decoded in this process at once.
"""

from minirt.jail.decoding import decode, expect, session, trust_all_files, trust_no_files

__all__ = ["decode", "expect", "session", "trust_all_files", "trust_no_files"]

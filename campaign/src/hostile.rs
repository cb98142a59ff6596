//! Saved states with damaged contents and a right checksum.

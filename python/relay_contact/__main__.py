"""The command `relay-contact`, also as `python -m relay_contact`."""

import sys

from relay_contact.command import main

if __name__ == "__main__":
    sys.exit(main())

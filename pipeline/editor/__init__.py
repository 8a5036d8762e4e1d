"""The editor in the browser: one page, served to this machine alone.

`serving` lets the right requests in and nothing else, `wire` says how the page and this program
speak, `bench` holds what is worked on. The page itself lies in `page`, as it is shipped.
"""

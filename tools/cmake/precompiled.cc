// A source that needs nothing: its target compiles the headers that others use.

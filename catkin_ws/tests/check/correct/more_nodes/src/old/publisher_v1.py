# The first try, in Python 2. Nothing uses it.
print "hello"

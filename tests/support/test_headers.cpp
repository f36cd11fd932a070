// Nothing but the headers that all test programs have precompiled.

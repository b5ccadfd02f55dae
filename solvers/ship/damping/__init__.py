"""Roll damping of a whole ship without speed by Ikeda's components, and her roll in a random sea with it.

Speed, in which lift damping acts, is left out: the lab's ships make no way.
"""

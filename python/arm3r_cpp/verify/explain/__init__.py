"""Why a formula is wrong: hypotheses about the whole, the terms that its entries read, and edits that mend it.

In come the user's formula, the truth, and which entries differ. Out come causes, terms and edits, none of them without
a confirmation at states and arms that played no part in finding it. `causes` goes the way; `differences` tells what is
no mistake, `constants` what is one of a number. `hypotheses` and `frames` try mistakes that change the formula as a
whole; `spectrum` and `terms` read entries as sums of sines and cosines with monomials of the parameters, those of the
dynamics in the `parts` before each product of rates; `edits` lists the single edits of a text, `repair` tries them.
This room prints nothing.
"""

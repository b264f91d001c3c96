"""The live page: scene, plots, text and sliders around the simulator, in a browser.

In comes a run or a scenario, out goes HTML: the installed page with these data in it. `page` finds the page and puts
data into it, `page_data` says what they are, `server` serves the page on this computer, `show` opens it in a notebook
or a browser. The page itself is written in web/page, and `make page` builds it; an installation may lack it, and then
every function here raises UsageError with one line that says how to get it.
"""

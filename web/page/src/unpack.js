/** The first script of the page that opens from disk: unpacks the page's own, which is executed by its hash alone. */
import { make } from "./app/dom.js";
import { given, unpacked } from "./app/given.js";

unpacked(given("arm3r-core").page).then((bytes) => document.body.append(make("script", { textContent: new TextDecoder().decode(bytes) })));

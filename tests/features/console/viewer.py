"""Looks at the console's pages in Debian's Chromium, driven by selenium, without a window."""

import json
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from selenium.common.exceptions import WebDriverException
from selenium.webdriver import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.remote.webelement import WebElement

from tests.features.console.browser import DrivenBrowser
from tests.servers import EVIL
from tests.waiting import HANG, until

HOLD = 10.0
"""The time after which a held button that has done nothing is held anew [s]."""
PRESSES = "return document.querySelector('rest-button[main]').presses"

LANDING = """
const [kind, selector] = arguments, land = (event) => {
  const found = kind === "click" ? event.target.closest(selector) : document.querySelector(selector);
  window.landed = found !== null && found.ariaDisabled !== "true";
};
window.landed = false;
addEventListener(kind, land, { capture: true, once: true });
"""
"""Notices whether the next click is on an element that matches, or the next key finds one, and it can be used."""

TELLS = """
const texts = new WeakMap();
globalThis.everTold = [];
new MutationObserver(() => {
  for (const one of document.querySelectorAll(".told p")) {
    if (texts.get(one) === one.textContent) continue;
    texts.set(one, one.textContent);
    everTold.push(one.textContent);
  }
}).observe(document, { subtree: true, childList: true, characterData: true });
"""
"""Keeps all messages at the foot of a page, where good news stays for some seconds only."""


class Viewer:
    """A window of the browser; `open` begins a page as a first visitor sees it.

    It keeps the complaints of pages; an `overhearing` one also keeps their requests, which costs processor time. The
    script `first` runs before each page.
    """

    def __init__(self, *, overhearing: bool = False, first: str = "") -> None:
        self._logs, self._first, self._address = ["browser", *["performance"] * overhearing], first, ""
        self._browser = DrivenBrowser(*self._logs, size=(1400, 800))
        self.driver = self._browser.driver
        self.driver.set_script_timeout(HANG)
        self._before = ""

    def open(self, address: str, path: str = "", *, ready: str = "main h1", width: int = 1400, **kept: str) -> None:
        """Open a page and wait until it shows `ready`; `kept` is what it stored earlier, as `theme="dark"`."""
        self._address = address
        # The last page may still send requests to its console. An empty page that it opens itself keeps its process.
        self.run("location.replace('about:blank')")
        self.size(width)
        where = {"origin": address.rstrip("/"), "storageTypes": "local_storage,session_storage,cookies"}
        self.command("Storage.clearDataForOrigin", where)
        if self._before:
            self.command("Page.removeScriptToEvaluateOnNewDocument", {"identifier": self._before})
        # Chromium may begin the window with an empty page of its own, which has no storage.
        memory = (
            f"for (const [key, value] of {json.dumps([*kept.items()])}) localStorage.setItem(`lumen.${{key}}`, value);"
        )
        script = f"if (location.origin !== 'null') {{ {memory} {TELLS} {self._first} }}"
        self._before = self.command("Page.addScriptToEvaluateOnNewDocument", {"source": script})["identifier"]
        for kind in self._logs:
            self.log(kind)
        self.driver.get(address + path)
        self.until(lambda: self.all(ready))

    def size(self, width: int, height: int = 800) -> None:
        """Make the page so large [px]."""
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.command("Emulation.setDeviceMetricsOverride", metrics)

    def command(self, name: str, fields: dict[str, Any]) -> Any:
        """Send a command of the protocol of its developer tools, and return the result."""
        return self.driver.execute("executeCdpCommand", {"cmd": name, "params": fields})["value"]

    def run(self, script: str, *arguments: Any) -> Any:
        return self.driver.execute_script(script, *arguments)

    def all(self, selector: str) -> list[WebElement]:
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def text(self, selector: str) -> str:
        """Return the text of the visible elements that match, read in one step since the page may redraw them."""
        seen = "[...document.querySelectorAll(arguments[0])].filter(e => e.checkVisibility())"
        return str(self.run(f"return {seen}.map(e => e.innerText).join('\\n')", selector))

    def until(self, condition: Callable[[], object]) -> None:
        """Wait until the condition holds; a failure shows the text of the page."""
        until(condition, HANG, shown=lambda: self.text("body"))

    def shows(self, text: str, selector: str = "body") -> None:
        """Wait until the visible elements that match contain the text."""
        self.until(lambda: text in self.text(selector))

    def tells(self, text: str) -> None:
        """Wait until a message with this text was at the foot of the page; it may be gone since."""
        self.until(lambda: any(text in one for one in self.run("return everTold")))

    def click(self, selector: str) -> None:
        """Click the first match; retry while the page draws it anew, or disables it as it is away for a moment."""

        def clicked() -> bool:
            with suppress(WebDriverException, IndexError):
                found = self.all(selector)[0]
                return found.is_enabled() and self.lands(found, selector)
            return False

        self.until(clicked)

    def lands(self, element: WebElement, selector: str) -> bool:
        """Scroll to a match and click it; return False if the page moved it meanwhile, or it could not be used."""
        self.run(LANDING, "click", selector)
        self.run("arguments[0].scrollIntoView({ block: 'nearest' })", element)
        element.click()
        return self.run("return window.landed") is not False  # undefined on the page to which the click led

    def hold(self, find: Callable[[], WebElement | None], text: str) -> None:
        """Hold the element until a message has this text; again if the page was away, or drew it anew, meanwhile."""
        before = len(self.run("return everTold"))

        def told() -> bool:
            return any(text in one for one in self.run("return everTold")[before:])

        def held() -> bool:
            with suppress(WebDriverException, AssertionError):
                if (found := find()) and not told():
                    ActionChains(self.driver).click_and_hold(found).perform()
                    until(told, HOLD)
            ActionChains(self.driver).release().perform()
            return told()

        self.until(held)

    def press(self, key: str, selector: str, *, holding: Callable[[], None] | None = None) -> None:
        """Press the key of the first match; again while that can not be used, as the page is away for a moment.

        The key is released after `holding`, without it at once.
        """

        def pressed() -> bool:
            self.run(LANDING, "keydown", selector)
            if not holding:
                self.type(key)
                return bool(self.run("return window.landed"))
            ActionChains(self.driver).key_down(key).perform()
            if landed := bool(self.run("return window.landed")):
                holding()
            ActionChains(self.driver).key_up(key).perform()
            return landed

        self.until(pressed)

    def type(self, *keys: str) -> None:
        ActionChains(self.driver).send_keys(*keys).perform()

    def escape_twice(self) -> None:
        """Press Escape twice, again if a slow machine passed the second on too late for the first."""

        def pressed() -> bool:
            before = self.run(PRESSES)
            self.type(Keys.ESCAPE, Keys.ESCAPE)
            return bool(self.run(PRESSES) > before)

        self.until(pressed)

    def complaints(self) -> list[str]:
        """Return the warnings and errors in the browser's log, without those of other tests' pages."""
        said = [entry["message"] for entry in self.log("browser") if entry["level"] in ("SEVERE", "WARNING")]
        others = ("http://127.0.0.1:", f"http://{EVIL}:")  # pages of other tests in this browser
        return [one for one in said if one.startswith(self._address) or not one.startswith(others)]

    def requests(self) -> list[str]:
        """Return the addresses that the page has requested since the last call."""
        said = [json.loads(entry["message"]) for entry in self.log("performance")]
        own = [one["message"] for one in said if one["webview"] == self.driver.current_window_handle]
        return [str(m["params"]["request"]["url"]) for m in own if m["method"] == "Network.requestWillBeSent"]

    def log(self, kind: str) -> list[dict[str, Any]]:
        """Return the entries since the last call: the driver receives those of other contexts, too."""
        return list(self.driver.execute("getLog", {"type": kind})["value"])

    def close(self) -> None:
        self._browser.close()

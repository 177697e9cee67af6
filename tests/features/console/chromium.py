"""Windows with pages of the console, and what a person sees and does there."""

from collections.abc import Sequence
from contextlib import suppress
from typing import Any

from selenium import webdriver
from selenium.common.exceptions import WebDriverException
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.remote.webelement import WebElement

from tests.features.console.browser import DrivenBrowser
from tests.waiting import HANG, until

REST = "rest-button[main] button.rest"
PRESSES = "return document.querySelector('rest-button[main]')?.presses ?? 0"
SAID = """
const said = document.querySelector("rest-button[main] .rest-said");
if (said) return said.hidden ? "" : said.innerText;
const broken = document.querySelector(".broken");
return broken && broken.offsetParent ? broken.innerText : "";
"""
QUIET = """
const said = document.querySelector("rest-button[main] .rest-said");
if (said) said.querySelector(":scope > button").click();
document.activeElement?.blur();
"""


class Chromium:
    """Windows of a new user's browser in English, until `close`; each has this `size` [px]."""

    def __init__(self, size: tuple[int, int] = (1200, 900)) -> None:
        self._browser = DrivenBrowser(size=size, page_load_strategy="none")
        self.driver = self._browser.driver
        self.driver.set_script_timeout(HANG)

    def run(self, script: str, *arguments: Any) -> Any:
        """Run a script in the page, and return its result."""
        return self.driver.execute_script(script, *arguments)

    def open(self, address: str) -> None:
        """Open an address, and don't wait until it has loaded."""
        self.driver.get(address)

    def window(self) -> str:
        """Open another window, switch to it, and return its handle."""
        return self._browser.window()

    def look(self, window: str) -> None:
        self.driver.switch_to.window(window)

    def find(self, selector: str) -> WebElement:
        """Wait for an element that matches and is displayed, and return the first."""
        found: list[WebElement] = []

        def there() -> bool:
            found[:] = [one for one in self.all(selector) if one.is_displayed()]
            return bool(found)

        until(there, HANG)
        return found[0]

    def all(self, selector: str) -> Sequence[WebElement]:
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def text(self) -> str:
        """Return the text that the page shows."""
        return str(self.run("return document.body ? document.body.innerText : ''"))

    def shows(self, *texts: str) -> bool:
        shown = self.text()
        return all(text in shown for text in texts)

    def click(self, selector: str, text: str) -> None:
        """Click the first match with this text; retry, since new entries may move it meanwhile."""

        def clicked() -> bool:
            with suppress(WebDriverException, StopIteration):
                next(one for one in self.all(selector) if text in one.text).click()
                return True
            return False

        until(clicked, HANG)

    def rest(self, *, keys: bool = False) -> None:
        """Press Rest as a person does, as soon as the page has it: with the mouse, or Escape twice.

        Two keys that a slow machine passes on too late for one another are pressed again.
        """

        def pressed() -> bool:
            try:
                if not (found := self.all(REST)):
                    return False
                if keys:
                    before = self.run(PRESSES)
                    webdriver.ActionChains(self.driver, 0).send_keys(Keys.ESCAPE, Keys.ESCAPE).perform()
                    return bool(self.run(PRESSES) > before)
                found[0].click()
            except WebDriverException:  # the page was another one meanwhile
                return False
            return True

        until(pressed, HANG)

    def said(self) -> str:
        """Return the page's text about the outcome of Rest; empty if it shows none."""
        return str(self.run(SAID))

    def quiet(self) -> None:
        """Close the notice about an earlier Rest."""
        self.run(QUIET)

    def close(self) -> None:
        self._browser.close()
